// Error of ambient occlusion against 1,024 stratified rays in double precision, and what it costs; beside it
// two screen-space methods, which see what the picture shows and nothing else.
//
//   occlusion_error [repetitions] [shader folder] > occlusion_error.csv
//
// Errors are over 300 pixels at random. Times, unless there are 0 repetitions, are medians of interleaved
// repetitions, in units of drawing the scene's spheres. The screen-space methods are computed here in double
// precision from exact distances and normals: once with so many samples that what is left is what they cannot
// see, and once with as many as 4 x 4 pixels could share at the price of the renderer's look-ups. "turned":
// how much the value of the same points of the surface changes when the camera turns by 15 degrees about the
// scene; it should not.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/geometric.hpp>
#include <map>

#include "bench/bench_scenes.h"
#include "render/gl/context.h"
#include "render/renderer.h"
#include "tests/support/occlusion_truth.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus::bench {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr std::size_t kPlaces = 300;

struct Setting {
  int samples, directions;
  double texel;
};
const Setting kSettings[] = {{1, 16, 0.5}, {1, 32, 0.5}, {1, 64, 0.5}, {1, 128, 0.5},
                             {1, 64, 1.0}, {2, 64, 0.5}, {4, 64, 0.5}, {8, 64, 0.5}};

/// A picture as screen-space methods see it.
struct Screen {
  const View& view;
  HitImage hits;

  /// View-space point of a pixel; nothing if it shows the background or lies outside.
  bool pointAt(int x, int y, glm::dvec3& point) const {
    if (x < 0 || y < 0 || x >= view.size.width || y >= view.size.height) return false;
    const auto i = static_cast<std::size_t>(y * view.size.width + x);
    if (!std::isfinite(hits.distance[i])) return false;
    const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
    point = ray.origin + static_cast<double>(hits.distance[i]) * ray.direction;
    return true;
  }
  glm::dvec2 project(const glm::dvec3& p) const {
    const double scale =
        view.pixelSize * (view.projection == Projection::perspective ? view.distance - p.z : 1);
    return view.center + glm::dvec2(p) / scale;
  }
};

// Points in the hemisphere over the surface, counted as hidden if the picture shows something in front of
// them (Mittring, Finding Next Gen: CryEngine 2, SIGGRAPH 2007 courses, doi 10.1145/1281500.1281671, with
// points above the surface only).
double openByPoints(const Screen& screen, const test::OcclusionPlace& place, double radius, int samples,
                    test::Random& random) {
  double hidden = 0, sky = 0;
  for (int i = 0; i < samples; ++i) {
    glm::dvec3 direction = random.direction();
    if (glm::dot(direction, place.normal) < 0) direction = -direction;
    const double cosine = glm::dot(direction, place.normal);
    sky += cosine;
    const glm::dvec3 sample = place.point + random.uniform(0, radius) * direction;
    const glm::dvec2 pixel = screen.project(sample);
    glm::dvec3 seen;
    if (!screen.pointAt(static_cast<int>(std::floor(pixel.x)), static_cast<int>(std::floor(pixel.y)), seen))
      continue;
    if (seen.z > sample.z + 1e-3 * radius)
      hidden += cosine * test::occluderWeight(glm::length(seen - place.point), radius);
  }
  return 1 - hidden / sky;
}

// Horizons on both sides of slices through the eye's ray, and the cosine-weighted sky between them (Jimenez,
// Wu, Pesce, Jarabo, Practical Real-Time Strategies for Accurate Indirect Occlusion, SIGGRAPH 2016 courses).
double openByHorizons(const Screen& screen, const test::OcclusionPlace& place, double radius, int slices,
                      int steps) {
  const glm::dvec3 toEye = screen.view.projection == Projection::perspective
                               ? glm::normalize(glm::dvec3(0, 0, screen.view.distance) - place.point)
                               : glm::dvec3(0, 0, 1);
  const double perPixel =
      screen.view.pixelSize *
      (screen.view.projection == Projection::perspective ? screen.view.distance - place.point.z : 1);
  const double reach = std::min(radius / perPixel, 1.0 * screen.view.size.width);
  double open = 0;
  for (int slice = 0; slice < slices; ++slice) {
    const double angle = kPi * (slice + 0.5) / slices;
    const glm::dvec2 along(std::cos(angle), std::sin(angle));
    const glm::dvec3 axis = glm::normalize(glm::cross(glm::dvec3(along, 0), toEye));
    const glm::dvec3 tangent = glm::cross(toEye, axis);
    const glm::dvec3 projected = place.normal - axis * glm::dot(place.normal, axis);
    const double length = glm::length(projected);
    const double n = std::atan2(glm::dot(projected, tangent), glm::dot(projected, toEye));
    double horizon[2];
    for (const int side : {0, 1}) {
      const double sign = side == 0 ? -1 : 1;
      // Down to the tangent plane, which hides what is below it.
      double best = std::cos(std::clamp(n + sign * kPi / 2, -kPi, kPi));
      const double floor = best;
      for (int k = 0; k < steps; ++k) {
        const double share = (k + 0.5) / steps, step = std::max(1.0, share * share * reach);
        glm::dvec3 seen;
        const int x = place.x + static_cast<int>(std::lround(sign * step * along.x));
        const int y = place.y + static_cast<int>(std::lround(sign * step * along.y));
        if (!screen.pointAt(x, y, seen)) continue;
        const glm::dvec3 to = seen - place.point;
        const double distance = glm::length(to);
        if (distance < 1e-9) continue;
        const double weight = test::occluderWeight(distance, radius);
        best = std::max(best, floor + weight * (glm::dot(to, toEye) / distance - floor));
      }
      horizon[side] = sign * std::acos(std::clamp(best, -1.0, 1.0));
      horizon[side] = n + std::clamp(horizon[side] - n, -kPi / 2, kPi / 2);
    }
    const auto arc = [&](double h) {
      return 0.25 * (-std::cos(2 * h - n) + std::cos(n) + 2 * h * std::sin(n));
    };
    open += length * (arc(horizon[0]) + arc(horizon[1])) / slices;
  }
  return open;
}

RenderSettings settingsOf(const Setting& setting, double radius) {
  RenderSettings settings;
  settings.samples = setting.samples;
  settings.occlusion.on = true;
  settings.occlusion.radius = radius;
  settings.occlusion.directions = setting.directions;
  settings.occlusion.texelSize = setting.texel;
  return settings;
}

void print(const std::string& scene, double radius, const std::string& method, const Setting& setting,
           const test::Deviation& d, double turned, double maps, double pass) {
  const auto time = [](double value) { return value > 0 ? fmt::format("{:.2f}", value) : std::string(); };
  fmt::print("\"{}\",{},{},{},{},{},{:.4f},{:+.4f},{:.3f},{:.4f},{},{}\n", scene, radius, method,
             setting.samples, setting.directions, setting.texel, d.rms, d.mean, d.largest, turned, time(maps),
             time(pass));
  std::fflush(stdout);
}

/// The scene seen from another side, and where it shows the places of the first view.
struct Turned {
  View view;
  std::vector<test::OcclusionPlace> places;  // those that are seen in both
  std::vector<std::size_t> from;             // their indices in the first view
};

Turned turn(Renderer& renderer, const View& view, const std::vector<test::OcclusionPlace>& places) {
  const double angle = kPi / 12, c = std::cos(angle), s = std::sin(angle);
  const glm::dmat3 rotation(c, 0, -s, 0, 1, 0, s, 0, c);
  Turned out;
  out.view = view;
  out.view.rotation = rotation * view.rotation;
  const Screen screen{out.view,
                      renderer.renderHits(out.view, {.distance = true, .normal = true, .id = false})};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 point = rotation * places[i].point;
    const glm::dvec2 pixel = screen.project(point);
    test::OcclusionPlace there{
        static_cast<int>(std::floor(pixel.x)), static_cast<int>(std::floor(pixel.y)), {}, {}, places[i].open};
    if (!screen.pointAt(there.x, there.y, there.point) || glm::length(there.point - point) > 0.15) continue;
    there.normal = glm::normalize(
        glm::dvec3(screen.hits.normal[static_cast<std::size_t>(there.y * view.size.width + there.x)]));
    if (glm::dot(there.normal, rotation * places[i].normal) < 0.98) continue;
    out.places.push_back(there);
    out.from.push_back(i);
  }
  return out;
}

double changeOf(const Turned& turned, const std::vector<double>& before, const std::vector<double>& after) {
  double sum = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double d = after[i] - before[turned.from[i]];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(after.size(), 1)));
}

void measure(const std::string& name, const Primitives& given, const View& view, double radius,
             int repetitions, const std::string& shaderDir) {
  Primitives scene = given;
  test::whiten(scene);
  Renderer renderer(RendererOptions{.shaderDir = shaderDir, .timePasses = true, .maxTileSize = 0});
  renderer.setPrimitives(std::make_shared<Primitives>(scene));
  const std::vector<test::OcclusionPlace> places =
      test::occlusionPlaces(renderer, scene, view, radius, kPlaces, 32);
  const Turned turned = turn(renderer, view, places);

  constexpr std::size_t kCount = std::size(kSettings);
  std::vector<double> maps[kCount], pass[kCount];
  test::Deviation deviations[kCount];
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    for (std::size_t s = 0; s < kCount; ++s) {
      std::map<std::string, double> before;
      for (const PassStats& p : renderer.stats().passes) before[p.name] = p.milliseconds;
      const std::vector<float> picture =
          test::drawFloats(renderer, view, test::ambientOnly(), settingsOf(kSettings[s], radius));
      deviations[s] = test::deviationFrom(places, test::valuesAt(places, picture, view));
      if (repetition < 0) continue;
      std::map<std::string, double> spent;
      for (const PassStats& p : renderer.stats().passes) spent[p.name] = p.milliseconds - before[p.name];
      maps[s].push_back(spent["occlusion maps"] / spent["spheres"]);
      pass[s].push_back((spent["occlusion"] + spent["occlusion gather"]) / spent["spheres"]);
    }
  }
  for (std::size_t s = 0; s < kCount; ++s) {
    const auto valuesIn = [&](const View& seen, const std::vector<test::OcclusionPlace>& where) {
      return test::valuesAt(
          where, test::drawFloats(renderer, seen, test::ambientOnly(), settingsOf(kSettings[s], radius)),
          seen);
    };
    const double change = changeOf(turned, valuesIn(view, places), valuesIn(turned.view, turned.places));
    print(name, radius, "maps", kSettings[s], deviations[s], change, repetitions > 0 ? median(maps[s]) : 0,
          repetitions > 0 ? median(pass[s]) : 0);
  }

  const Screen screen{view, renderer.renderHits(view, {.distance = true, .normal = true, .id = false})};
  const Screen beside{turned.view,
                      renderer.renderHits(turned.view, {.distance = true, .normal = true, .id = false})};
  // Without a limit a screen-space method still needs one: as far as the scene reaches.
  const double limit = radius > 0 ? radius : 2 * scene.bounds().radius;
  const auto compare = [&](const char* method, int samples, const auto& valueAt) {
    std::vector<double> before, after;
    for (const test::OcclusionPlace& place : places) before.push_back(valueAt(screen, place));
    for (const test::OcclusionPlace& place : turned.places) after.push_back(valueAt(beside, place));
    print(name, radius, method, {1, samples, 0}, test::deviationFrom(places, before),
          changeOf(turned, before, after), 0, 0);
  };
  for (const int samples : {1024, 128}) {
    test::Random random(3);
    compare("screen points", samples, [&](const Screen& s, const test::OcclusionPlace& place) {
      return openByPoints(s, place, limit, samples, random);
    });
  }
  for (const int samples : {64 * 2 * 256, 16 * 2 * 8, 8 * 2 * 4}) {
    const int slices = samples > 1000 ? 64 : samples > 100 ? 16 : 8;
    compare("screen horizons", samples, [&](const Screen& s, const test::OcclusionPlace& place) {
      return openByHorizons(s, place, limit, slices, samples / slices / 2);
    });
  }
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(0, std::atoi(argv[1])) : 5;
    const std::string shaderDir = argc > 2 ? argv[2] : "";
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "scene,radius,method,samples,directions,texel,rms,mean,largest,turned,maps_per_spheres,pass_per_"
        "spheres\n");
    const auto spheres = test::randomSpheres(4000, 3);
    const bench::BenchScene protein = bench::loadScene({"2hhb.pdb.gz"}, {1024, 768});
    const bench::BenchScene complex = bench::loadScene({"7ddo.pdb.gz"}, {1024, 768});
    View close = protein.view;  // most of what occludes lies outside the picture
    close.pixelSize *= 0.25;
    const auto measure = [&](const char* name, const Primitives& scene, const View& view, double radius) {
      bench::measure(name, scene, view, radius, repetitions, shaderDir);
    };
    measure("hemoglobin", *protein.primitives, protein.view, 30);
    measure("hemoglobin, close", *protein.primitives, close, 30);
    measure("4000 random spheres", *spheres, test::viewOf(*spheres, {512, 512}), 30);
    measure("4000 random spheres", *spheres, test::viewOf(*spheres, {512, 512}), 10);
    measure("ACE2", *complex.primitives, complex.view, 30);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occlusion_error: %s\n", error.what());
    return 1;
  }
  return 0;
}

#include "tests/support/occlusion_truth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus::test {

namespace {

// How much the nearest end of what a ray leaves counts; 0 if it meets nothing.
double occlusionOfRay(const Primitives& scene, const glm::dvec3& point, const glm::dvec3& direction,
                      double radius) {
  double hidden = 0;
  for (const SpherePrimitive& s : scene.spheres) {
    const glm::dvec3 toCenter = glm::dvec3(s.center) - point;
    const double along = glm::dot(toCenter, direction), r = static_cast<double>(s.radius);
    const double under = r * r - (glm::dot(toCenter, toCenter) - along * along);
    if (along <= 0 || under <= 0 || along - std::sqrt(under) < 1e-6) continue;
    hidden = std::max(hidden, occluderWeight(along + std::sqrt(under), radius));
  }
  return hidden;
}

// By stratified rays whose density is the cosine.
double exactOpenness(const Primitives& scene, const glm::dvec3& point, const glm::dvec3& normal,
                     double radius, int side) {
  const glm::dvec3 hint = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(hint, normal)), up = glm::cross(normal, right);
  double hidden = 0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double r = std::sqrt((i + 0.5) / side), angle = 2 * M_PI * (j + 0.5 + 0.5 * (i & 1)) / side;
      const glm::dvec3 direction =
          r * std::cos(angle) * right + r * std::sin(angle) * up + std::sqrt(1 - r * r) * normal;
      hidden += occlusionOfRay(scene, point, direction, radius);
    }
  }
  return 1 - hidden / (side * side);
}

}  // namespace

double occluderWeight(double distance, double radius) {
  return radius > 0 ? std::clamp(2 - 2 * distance / radius, 0.0, 1.0) : 1.0;
}

std::vector<OcclusionPlace> occlusionPlaces(Renderer& renderer, const Primitives& scene, const View& view,
                                            double radius, std::size_t count, int side) {
  const HitImage hits = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
  const glm::dmat3 toWorld = glm::transpose(view.rotation);
  Random random(7);
  std::vector<OcclusionPlace> out;
  for (std::size_t tries = 0; tries < 100 * count && out.size() < count; ++tries) {
    const int x = static_cast<int>(random.index(static_cast<std::size_t>(view.size.width)));
    const int y = static_cast<int>(random.index(static_cast<std::size_t>(view.size.height)));
    const auto i = static_cast<std::size_t>(y * view.size.width + x);
    if (hits.id[i] == 0) continue;
    const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
    OcclusionPlace place{x, y, ray.origin + static_cast<double>(hits.distance[i]) * ray.direction,
                         glm::normalize(glm::dvec3(hits.normal[i])), 1};
    place.open = exactOpenness(scene, toWorld * place.point + view.pivot - scene.origin,
                               glm::normalize(toWorld * place.normal), radius, side);
    out.push_back(place);
  }
  return out;
}

Deviation deviationFrom(const std::vector<OcclusionPlace>& places, const std::vector<double>& values) {
  Deviation d;
  const auto count = static_cast<double>(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double error = values[i] - places[i].open;
    d.mean += error / count;
    d.rms += error * error / count;
    d.largest = std::max(d.largest, std::abs(error));
  }
  d.rms = std::sqrt(d.rms);
  return d;
}

Lighting ambientOnly() {
  Lighting lighting;
  lighting.key.intensity = lighting.fill.intensity = lighting.specular = 0;
  lighting.ambient = 1;
  return lighting;
}

void whiten(Primitives& scene) {
  for (SpherePrimitive& s : scene.spheres) s.color = 0xFFFFFF;
  for (CylinderPrimitive& c : scene.cylinders) c.colorA = c.colorB = 0xFFFFFF;
}

std::vector<float> drawFloats(Renderer& renderer, const View& view, const Lighting& lighting,
                              const RenderSettings& settings) {
  MemorySink sink;
  renderer.renderPicture(view, lighting, Background{0, true}, settings, {PixelFormat::rgbaFloat, {}}, sink);
  std::vector<float> out(sink.bytes.size() / sizeof(float));
  std::memcpy(out.data(), sink.bytes.data(), sink.bytes.size());
  return out;
}

std::vector<double> valuesAt(const std::vector<OcclusionPlace>& places, const std::vector<float>& picture,
                             const View& view) {
  std::vector<double> out;
  for (const OcclusionPlace& place : places) {
    const int row = view.size.height - 1 - place.y;
    const auto pixel = static_cast<std::size_t>(row * view.size.width + place.x);
    out.push_back(static_cast<double>(picture[4 * pixel]));
  }
  return out;
}

}  // namespace meniscus::test

#include "core/occlusion_maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <thread>

#include "core/height_map.h"
#include "core/light_view.h"
#include "core/sampling.h"
#include "core/shared_math.h"

namespace meniscus {

namespace {

// Of all maps together: 128 MiB.
constexpr double kMaxTexels = 8.0 * (1 << 20);
// More would only cost memory: the slabs of a radius of 8 Å in a scene of 150 Å.
constexpr int kMaxSlabs = 32;
constexpr int kMaxMapSize = 4096;
constexpr double kHeights = 65534;  // that 16 bits can hold, beside 0 and some room for rounding

// Second dimension of Sobol's sequence: direction numbers v_k = v_(k-1) xor (v_(k-1) >> 1).
double sobol2(std::uint32_t i) {
  std::uint32_t bits = 0;
  for (std::uint32_t v = 1u << 31; i != 0; i >>= 1, v ^= v >> 1) {
    if ((i & 1u) != 0) bits ^= v;
  }
  return bits * 0x1p-32;
}

// What a ball alone holds inside stands for its part of the surface: it never reaches out of it, so that a
// surface does not occlude itself where it is convex. What negative balls cut away counts as if it were
// there.
std::vector<SpherePrimitive> coresOf(const std::vector<MetaballField>& fields) {
  std::vector<SpherePrimitive> cores;
  for (const MetaballField& field : fields) {
    float coefficient = 0, share = 0;  // of the ball before: most are alike
    for (const Metaball& ball : field.balls) {
      if (ball.coefficient != coefficient) {
        coefficient = ball.coefficient;
        share = static_cast<float>(coreShare(field.kernel, field.level, static_cast<double>(coefficient)));
      }
      if (share > 0) cores.push_back({ball.center, ball.support * share, ball.color, ball.id});
    }
  }
  return cores;
}

// How far a point of a primitive can lie from its centre.
double reachOf(const Primitives& primitives, const std::vector<SpherePrimitive>& cores) {
  float reach = 0;
  for (const SpherePrimitive& s : primitives.spheres) reach = std::max(reach, s.radius);
  for (const CylinderPrimitive& c : primitives.cylinders)
    reach = std::max(reach, 0.5f * glm::length(c.b - c.a) + c.radius);
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) reach = std::max(reach, glm::length(e.axisA));
  for (const SpherePrimitive& s : cores) reach = std::max(reach, s.radius);
  return static_cast<double>(reach);
}

// One map while it is drawn. Coordinates: x, y in texels, z in Å above the far plane.
class Canvas {
 public:
  Canvas(const OcclusionMaps& all, const OcclusionMap& map, const glm::dvec3& origin)
      : rotation_(map.view.rotation),
        texels_(static_cast<std::size_t>(map.view.size.width) *
                static_cast<std::size_t>(map.view.size.height)),
        heights_(texels_ * static_cast<std::size_t>(map.slabs) + HeightMap::kBeyond, 0) {
    const double perTexel = 1 / map.view.pixelSize;
    const glm::dmat3 scaled = glm::dmat3({perTexel, 0, 0}, {0, perTexel, 0}, {0, 0, 1}) * map.view.rotation;
    map_ = {map.view.size.width,
            map.view.size.height,
            map.slabs,
            static_cast<float>(map.view.pixelSize),
            static_cast<float>(1 / all.slabHeight),
            static_cast<float>(1 / all.step),
            glm::mat3(scaled),
            glm::vec3(scaled * (origin - map.view.pivot) + glm::dvec3(map.view.center, -map.view.farZ)),
            heights_.data()};
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void draw(std::span<const SpherePrimitive> spheres) { raiseBalls(map_, spheres); }

  void draw(const CylinderPrimitive& s) {
    const glm::vec3 along = rotation_ * (s.b - s.a);
    const float halfLength = 0.5f * glm::length(along);
    if (!(s.radius > 0 && halfLength > 0)) return;
    const glm::vec3 axis = along / (2 * halfLength);
    const glm::vec3 c = map_.turn * (0.5f * (s.a + s.b)) + map_.shift;
    const auto extent = [&](float a) {
      return (halfLength * std::abs(a) + s.radius * std::sqrt(std::max(1 - a * a, 0.0f))) / map_.texel;
    };
    const TexelRange rows(c.y, extent(axis.y), map_.height), columns(c.x, extent(axis.x), map_.width);
    std::uint16_t* slab = map_.slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        const f32::Chord chord =
            f32::cylinderChord(fromCenter(x, y, c), {0, 0, -1}, axis, halfLength, s.radius);
        if (chord.hit) raise(slab[static_cast<std::ptrdiff_t>(y) * map_.width + x], c.z + chord.entry.z);
      }
    }
  }

  void draw(const EllipsoidPrimitive& e) {
    const glm::vec3 radii(glm::length(e.axisA), glm::length(e.axisB), e.shortest);
    if (!(radii.x > 0 && radii.y > 0 && radii.z > 0)) return;
    const glm::vec3 u = rotation_ * (e.axisA / radii.x), v = rotation_ * (e.axisB / radii.y),
                    w = glm::cross(u, v);
    const glm::vec3 c = map_.turn * e.center + map_.shift;
    const auto extent = [&](int k) { return glm::length(radii * glm::vec3(u[k], v[k], w[k])) / map_.texel; };
    const TexelRange rows(c.y, extent(1), map_.height), columns(c.x, extent(0), map_.width);
    std::uint16_t* slab = map_.slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        const f32::Chord chord = f32::ellipsoidChord(fromCenter(x, y, c), {0, 0, -1}, u, v, w, radii);
        if (chord.hit) raise(slab[static_cast<std::ptrdiff_t>(y) * map_.width + x], c.z + chord.entry.z);
      }
    }
  }

  // To the right of a row's last texel lies the first of the next, which nobody takes for its neighbour.
  void pack(OcclusionTexel* out) const {
    for (int slab = 0; slab < map_.slabs; slab += 2) {
      const std::uint16_t* const heights = heights_.data() + static_cast<std::size_t>(slab) * texels_;
      const auto count = static_cast<std::size_t>(std::min(kSlabsPerTexel, map_.slabs - slab));
      for (std::size_t i = 0; i < texels_; ++i) {
        for (std::size_t k = 0; k < count; ++k) {
          const std::uint16_t* const texel = heights + k * texels_ + i;
          out[i][k] = texel[0] | std::uint32_t{texel[1]} << 16;
        }
      }
      out += texels_;
    }
  }

 private:
  // A texel's centre [Å].
  glm::vec3 fromCenter(int x, int y, const glm::vec3& c) const {
    return {(static_cast<float>(x) + 0.5f - c.x) * map_.texel,
            (static_cast<float>(y) + 0.5f - c.y) * map_.texel, 0};
  }
  void raise(std::uint16_t& texel, float height) const {
    const auto value = static_cast<std::uint16_t>(std::clamp(height * map_.perStep, 1.0f, 65535.0f));
    if (value > texel) texel = value;
  }

  glm::mat3 rotation_;
  std::size_t texels_;  // of a slab
  std::vector<std::uint16_t> heights_;
  HeightMap map_;
};

// Chooses views and sizes; nothing is drawn.
OcclusionMaps layOut(const Primitives& primitives, const std::vector<SpherePrimitive>& cores,
                     const View& camera, const OcclusionSettings& settings) {
  const BoundingSphere bounds = primitives.bounds();
  const std::vector<glm::dvec3> directions = occlusionDirections(settings.directions);
  OcclusionMaps all;
  all.reach = reachOf(primitives, cores);
  all.texelSize = std::max({settings.texelSize, pixelFootprint(camera, bounds), bounds.radius * 1e-6});
  for (;;) {
    double span = 0, texels = 0;
    all.maps.clear();
    for (const glm::dvec3& direction : directions) {
      const DirectionalLight light{-(camera.rotation * direction), 1};
      OcclusionMap map;
      map.view = makeLightView(camera, light, bounds, all.texelSize, kMaxMapSize, all.texelSize);
      span = std::max(span, map.view.nearZ - map.view.farZ);
      all.maps.push_back(map);
    }
    const bool limited = settings.radius > 0;
    const double wanted = std::max(settings.radius, 4 * all.texelSize);
    const int slabs =
        limited
            ? static_cast<int>(std::clamp(std::ceil(2 * span / (wanted + all.reach)), 1.0, double{kMaxSlabs}))
            : 1;
    all.slabHeight = span / slabs;
    all.radius = limited ? std::max(wanted, all.slabHeight) : 0;
    all.step = span / kHeights;
    for (OcclusionMap& map : all.maps) {
      map.slabs = slabs;
      map.first = static_cast<std::uint32_t>(std::min(texels, kMaxTexels));
      texels += static_cast<double>(map.view.size.width) * map.view.size.height * ((slabs + 1) / 2);
    }
    if (texels <= kMaxTexels) {
      all.texels.resize(static_cast<std::size_t>(texels));
      return all;
    }
    all.texelSize *= 1.02 * std::cbrt(texels / kMaxTexels);
  }
}

}  // namespace

std::vector<glm::dvec3> occlusionDirections(int count) {
  std::vector<glm::dvec3> out;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    // In the middle of its stratum: neither pole is a direction.
    const double z = 1 - 2 * (radicalInverse2(i) + 0.5 / count);
    const double angle = 2 * 3.141592653589793 * sobol2(i), r = std::sqrt(std::max(1 - z * z, 0.0));
    out.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return out;
}

OcclusionMaps drawOcclusionMaps(const Primitives& primitives, const View& camera,
                                const OcclusionSettings& settings, const std::function<void()>& watch) {
  std::vector<SpherePrimitive> cores = coresOf(primitives.surfaces);
  cores.insert(cores.end(), primitives.filling.begin(), primitives.filling.end());
  OcclusionMaps all = layOut(primitives, cores, camera, settings);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](bool watched) {
    for (std::size_t i = next++; i < all.maps.size(); i = next++) {
      if (watched && watch) watch();
      Canvas canvas(all, all.maps[i], primitives.origin);
      canvas.draw(primitives.spheres);
      for (const CylinderPrimitive& c : primitives.cylinders) canvas.draw(c);
      for (const EllipsoidPrimitive& e : primitives.ellipsoids) canvas.draw(e);
      canvas.draw(cores);
      canvas.pack(all.texels.data() + all.maps[i].first);
    }
  };
  std::vector<std::jthread> others;
  const unsigned threads = std::min(std::thread::hardware_concurrency(), 64u);
  for (unsigned i = 1; i < threads; ++i) others.emplace_back(work, false);
  try {
    work(true);
  } catch (...) {
    next = all.maps.size();  // nobody begins another; the others are waited for
    throw;
  }
  others.clear();  // waits
  return all;
}

}  // namespace meniscus

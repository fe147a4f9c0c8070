#include "core/occlusion_maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

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
      : width_(map.view.size.width),
        height_(map.view.size.height),
        slabs_(map.slabs),
        texel_(static_cast<float>(map.view.pixelSize)),
        perSlab_(static_cast<float>(1 / all.slabHeight)),
        perStep_(static_cast<float>(1 / all.step)) {
    const double perTexel = 1 / map.view.pixelSize;
    const glm::dmat3 scaled = glm::dmat3({perTexel, 0, 0}, {0, perTexel, 0}, {0, 0, 1}) * map.view.rotation;
    turn_ = glm::mat3(scaled);
    shift_ = glm::vec3(scaled * (origin - map.view.pivot) + glm::dvec3(map.view.center, -map.view.farZ));
    rotation_ = glm::mat3(map.view.rotation);
    heights_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                        static_cast<std::size_t>(slabs_),
                    0);
  }

  void draw(const SpherePrimitive& s) {
    if (!(s.radius > 0)) return;
    const glm::vec3 c = turn_ * s.center + shift_;
    const float r = s.radius / texel_;
    const float r2 = r * r;
    const Range rows = range(c.y, r, height_), columns = range(c.x, r, width_);
    std::uint16_t* slab = slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      const float dy = static_cast<float>(y) + 0.5f - c.y;
      std::uint16_t* row = slab + static_cast<std::ptrdiff_t>(y) * width_;
      for (int x = columns.first; x <= columns.last; ++x) {
        const float dx = static_cast<float>(x) + 0.5f - c.x;
        const float under = r2 - dy * dy - dx * dx;
        if (under >= 0) raise(row[x], c.z + texel_ * std::sqrt(under));
      }
    }
  }

  void draw(const CylinderPrimitive& s) {
    const glm::vec3 along = rotation_ * (s.b - s.a);
    const float halfLength = 0.5f * glm::length(along);
    if (!(s.radius > 0 && halfLength > 0)) return;
    const glm::vec3 axis = along / (2 * halfLength);
    const glm::vec3 c = turn_ * (0.5f * (s.a + s.b)) + shift_;
    const auto extent = [&](float a) {
      return (halfLength * std::abs(a) + s.radius * std::sqrt(std::max(1 - a * a, 0.0f))) / texel_;
    };
    const Range rows = range(c.y, extent(axis.y), height_), columns = range(c.x, extent(axis.x), width_);
    std::uint16_t* slab = slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        const f32::Chord chord =
            f32::cylinderChord(fromCenter(x, y, c), {0, 0, -1}, axis, halfLength, s.radius);
        if (chord.hit) raise(slab[static_cast<std::ptrdiff_t>(y) * width_ + x], c.z + chord.entry.z);
      }
    }
  }

  void draw(const EllipsoidPrimitive& e) {
    const glm::vec3 radii(glm::length(e.axisA), glm::length(e.axisB), e.shortest);
    if (!(radii.x > 0 && radii.y > 0 && radii.z > 0)) return;
    const glm::vec3 u = rotation_ * (e.axisA / radii.x), v = rotation_ * (e.axisB / radii.y),
                    w = glm::cross(u, v);
    const glm::vec3 c = turn_ * e.center + shift_;
    const auto extent = [&](int k) { return glm::length(radii * glm::vec3(u[k], v[k], w[k])) / texel_; };
    const Range rows = range(c.y, extent(1), height_), columns = range(c.x, extent(0), width_);
    std::uint16_t* slab = slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        const f32::Chord chord = f32::ellipsoidChord(fromCenter(x, y, c), {0, 0, -1}, u, v, w, radii);
        if (chord.hit) raise(slab[static_cast<std::ptrdiff_t>(y) * width_ + x], c.z + chord.entry.z);
      }
    }
  }

  void pack(OcclusionTexel* out) const {
    const std::size_t area = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    for (int slab = 0; slab < slabs_; slab += 2) {
      for (int k = 0; k < kSlabsPerTexel; ++k) {
        if (slab + k >= slabs_) continue;  // empty
        const std::uint16_t* heights = heights_.data() + static_cast<std::size_t>(slab + k) * area;
        for (std::size_t i = 0; i + 1 < area; ++i)
          out[i][static_cast<std::size_t>(k)] = heights[i] | std::uint32_t{heights[i + 1]} << 16;
        out[area - 1][static_cast<std::size_t>(k)] = heights[area - 1];
      }
      out += area;
    }
  }

 private:
  struct Range {
    int first, last;
  };
  // Texels whose centres lie within `reach` of a place.
  static Range range(float place, float reach, int size) {
    const float low = std::ceil(place - reach - 0.5f), high = std::floor(place + reach - 0.5f);
    return {static_cast<int>(std::clamp(low, 0.0f, static_cast<float>(size))),
            static_cast<int>(std::clamp(high, -1.0f, static_cast<float>(size - 1)))};
  }
  // A texel's centre [Å].
  glm::vec3 fromCenter(int x, int y, const glm::vec3& c) const {
    return {(static_cast<float>(x) + 0.5f - c.x) * texel_, (static_cast<float>(y) + 0.5f - c.y) * texel_, 0};
  }
  std::uint16_t* slabOf(float height) {
    const int slab = static_cast<int>(std::clamp(height * perSlab_, 0.0f, static_cast<float>(slabs_) - 0.5f));
    return heights_.data() + static_cast<std::size_t>(slab) * static_cast<std::size_t>(width_) *
                                 static_cast<std::size_t>(height_);
  }
  void raise(std::uint16_t& texel, float height) const {
    const auto value = static_cast<std::uint16_t>(std::clamp(height * perStep_, 1.0f, 65535.0f));
    if (value > texel) texel = value;
  }

  int width_, height_, slabs_;
  float texel_, perSlab_, perStep_;
  glm::mat3 turn_{1.0f}, rotation_{1.0f};
  glm::vec3 shift_{0.0f};
  std::vector<std::uint16_t> heights_;
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
      for (const SpherePrimitive& s : primitives.spheres) canvas.draw(s);
      for (const CylinderPrimitive& c : primitives.cylinders) canvas.draw(c);
      for (const EllipsoidPrimitive& e : primitives.ellipsoids) canvas.draw(e);
      for (const SpherePrimitive& s : cores) canvas.draw(s);
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

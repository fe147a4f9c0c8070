#include "core/quadric_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "core/exact_quadrics.h"

namespace meniscus {

namespace {

using namespace exact;

constexpr Real kFar = std::numeric_limits<Real>::infinity();
constexpr int kTile = 8;  // pixels along a side

bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Kinds of primitives in view axes.
struct Sphere {
  Vec3 center;
  Real radius;
  std::uint32_t id;
};
struct Cylinder {
  Vec3 a, b;
  Real radius;
  std::uint32_t idA, idB;
};
struct Ellipsoid {
  ExactEllipsoid shape;
  std::uint32_t id;
};

/// Anything, by a ball that holds it.
struct Solid {
  enum class Kind : std::uint8_t { sphere, cylinder, ellipsoid } kind;
  std::uint32_t index;
  glm::dvec3 center;
  double reach;
};

struct Hit {
  Real distance = kFar;
  Vec3 normal{0};
  Real cosine = 0;
  std::uint32_t id = 0;
  bool fromInside = false;
};

/// All rays of a tile: a cone from the eye, or a cylinder.
struct Beam {
  bool cone = true;
  glm::dvec3 apex{0.0}, axis{0.0};
  double angle = 0, radius = 0;

  bool meets(const Solid& solid) const {
    const glm::dvec3 v = solid.center - apex;
    const double along = glm::dot(v, axis), aside = glm::length(v - along * axis);
    const double reach = solid.reach * (1 + 1e-9) + 1e-12 * (std::abs(along) + aside);
    if (!cone) return aside <= radius + reach;
    const double away = glm::length(v);
    if (away <= reach) return true;
    return std::atan2(aside, along) <= angle + std::asin(std::min(reach / away, 1.0)) + 1e-12;
  }
};

class QuadricTracer {
 public:
  QuadricTracer(const Primitives& primitives, const View& view, const ReferenceOptions& options,
                ReferenceImage& image);
  void trace();

 private:
  using Candidates = std::vector<std::uint32_t>;
  Beam beamOf(int x, int y) const;
  Hit cast(glm::dvec2 pixel, const Candidates& candidates) const;
  void meet(const Solid& solid, const ExactRay& ray, Real start, Hit& hit) const;
  bool otherSheet(const Hit& a, const Hit& b) const;
  bool grazing(const Hit& hit, glm::dvec2 pixel, const Candidates& candidates) const;
  void traceTile(int x0, int y0);

  const View& view_;
  const ReferenceOptions& options_;
  ReferenceImage& image_;
  std::vector<Sphere> spheres_;
  std::vector<Cylinder> cylinders_;
  std::vector<Ellipsoid> ellipsoids_;
  std::vector<Solid> solids_;
};

QuadricTracer::QuadricTracer(const Primitives& primitives, const View& view, const ReferenceOptions& options,
                             ReferenceImage& image)
    : view_(view), options_(options), image_(image) {
  const auto add = [&](Solid::Kind kind, std::size_t count, const Vec3& center, Real reach) {
    solids_.push_back({kind, static_cast<std::uint32_t>(count - 1), glm::dvec3(center),
                       static_cast<double>(reach) * (1 + 1e-12)});
  };
  for (const SpherePrimitive& s : primitives.spheres) {
    if (!isFinite(s.center) || !std::isfinite(s.radius) || !(s.radius > 0)) continue;
    spheres_.push_back({exactViewPoint(view, primitives.origin, s.center), Real(s.radius), s.id});
    add(Solid::Kind::sphere, spheres_.size(), spheres_.back().center, Real(s.radius));
  }
  for (const CylinderPrimitive& c : primitives.cylinders) {
    if (!isFinite(c.a) || !isFinite(c.b) || !std::isfinite(c.radius) || !(c.radius > 0) || c.a == c.b)
      continue;
    cylinders_.push_back({exactViewPoint(view, primitives.origin, c.a),
                          exactViewPoint(view, primitives.origin, c.b), Real(c.radius), c.idA, c.idB});
    const Cylinder& cylinder = cylinders_.back();
    add(Solid::Kind::cylinder, cylinders_.size(), (cylinder.a + cylinder.b) * Real(0.5),
        glm::length(cylinder.b - cylinder.a) * Real(0.5) + cylinder.radius);
  }
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) {
    const bool solid = isFinite(e.center) && isFinite(e.axisA) && isFinite(e.axisB) &&
                       std::isfinite(e.shortest) && e.shortest > 0;
    if (!solid) continue;
    ellipsoids_.push_back({exactEllipsoid(view, primitives.origin, e), e.id});
    const ExactEllipsoid& shape = ellipsoids_.back().shape;
    add(Solid::Kind::ellipsoid, ellipsoids_.size(), shape.center,
        std::max({shape.radii.x, shape.radii.y, shape.radii.z}));
  }
}

Beam QuadricTracer::beamOf(int x, int y) const {
  const double margin = options_.grazingShift;
  const glm::dvec2 low = glm::dvec2(x, y) - margin, high = glm::dvec2(x + kTile, y + kTile) + margin;
  const ExactRay axis = exactRay(view_, (low + high) / 2.0);
  Beam beam;
  beam.cone = view_.projection == Projection::perspective;
  beam.apex = glm::dvec3(axis.origin);
  beam.axis = glm::dvec3(axis.direction);
  for (const glm::dvec2 corner : {low, high, glm::dvec2(low.x, high.y), glm::dvec2(high.x, low.y)}) {
    const ExactRay ray = exactRay(view_, corner);
    beam.radius = std::max(beam.radius, static_cast<double>(glm::length(ray.origin - axis.origin)));
    const Real sine = glm::length(glm::cross(ray.direction, axis.direction));
    beam.angle = std::max(
        beam.angle, static_cast<double>(std::atan2(sine, glm::dot(ray.direction, axis.direction))) + 1e-12);
  }
  return beam;
}

void QuadricTracer::meet(const Solid& solid, const ExactRay& ray, Real start, Hit& hit) const {
  std::optional<ExactChord> chord;
  switch (solid.kind) {
    case Solid::Kind::sphere:
      chord = exactSphere(ray, spheres_[solid.index].center, spheres_[solid.index].radius);
      break;
    case Solid::Kind::cylinder:
      chord = exactCylinder(ray, cylinders_[solid.index].a, cylinders_[solid.index].b,
                            cylinders_[solid.index].radius);
      break;
    case Solid::Kind::ellipsoid:
      chord = exactEllipsoidChord(ray, ellipsoids_[solid.index].shape);
      break;
  }
  if (!chord) return;
  const bool inside = chord->in < start;
  const Real t = inside ? chord->out : chord->in;
  if (t < start || !(t < hit.distance)) return;
  const Vec3 point = ray.origin + t * ray.direction;
  Vec3 normal(0);
  if (solid.kind == Solid::Kind::sphere) {
    const Sphere& s = spheres_[solid.index];
    normal = point - s.center;
    hit.id = s.id;
  } else if (solid.kind == Solid::Kind::ellipsoid) {
    const ExactEllipsoid& e = ellipsoids_[solid.index].shape;
    const Vec3 slope = e.local(point - e.center) / e.radii / e.radii;
    normal = slope.x * e.axes[0] + slope.y * e.axes[1] + slope.z * e.axes[2];
    hit.id = ellipsoids_[solid.index].id;
  } else {
    const Cylinder& c = cylinders_[solid.index];
    const Real length = glm::length(c.b - c.a);
    const Vec3 axis = (c.b - c.a) / length;
    const Real height = glm::dot(point - c.a, axis);
    const Vec3 side = point - c.a - height * axis;
    const Real fromCap = std::min(std::abs(height), std::abs(length - height));
    if (fromCap < std::abs(glm::length(side) - c.radius)) {
      normal = height * 2 > length ? axis : -axis;
    } else {
      normal = side;
    }
    hit.id = height * 2 > length ? c.idB : c.idA;
  }
  hit.distance = t;
  hit.fromInside = inside;
  hit.normal = glm::normalize(normal) * Real(inside ? -1 : 1);
  hit.cosine = -glm::dot(hit.normal, ray.direction);
}

Hit QuadricTracer::cast(glm::dvec2 pixel, const Candidates& candidates) const {
  const ExactRay ray = exactRay(view_, pixel);
  const Real start = std::max((Real(view_.nearZ) - ray.origin.z) / ray.direction.z, Real(0));
  Hit hit;
  for (const std::uint32_t i : candidates) meet(solids_[i], ray, start, hit);
  return hit;
}

// As in core/reference_tracer.h.
bool QuadricTracer::otherSheet(const Hit& a, const Hit& b) const {
  if ((a.distance == kFar) != (b.distance == kFar)) return true;
  if (a.distance == kFar) return false;
  if (a.fromInside != b.fromInside) return true;
  const auto tangent = [](const Hit& hit) {
    const Real cosine = std::abs(hit.cosine);
    return cosine > 0 ? std::sqrt(std::max(1 - cosine * cosine, Real(0))) / cosine : kFar;
  };
  const Real shift = Real(options_.grazingShift) * Real(view_.pixelSize),
             t = std::max(a.distance, b.distance);
  const Real apart = view_.projection == Projection::perspective ? shift * t : shift;
  return std::abs(a.distance - b.distance) >
         (1 + 3 * std::min(tangent(a), tangent(b))) * apart + Real(1e-15) * t;
}

bool QuadricTracer::grazing(const Hit& hit, glm::dvec2 pixel, const Candidates& candidates) const {
  const double s = options_.grazingShift;
  const glm::dvec2 moves[] = {{s, 0}, {-s, 0}, {0, s}, {0, -s}};
  return std::any_of(std::begin(moves), std::end(moves),
                     [&](const glm::dvec2& move) { return otherSheet(hit, cast(pixel + move, candidates)); });
}

void QuadricTracer::traceTile(int x0, int y0) {
  const Beam beam = beamOf(x0, y0);
  Candidates candidates;
  for (std::uint32_t i = 0; i < solids_.size(); ++i)
    if (beam.meets(solids_[i])) candidates.push_back(i);
  const int x1 = std::min(x0 + kTile, view_.size.width), y1 = std::min(y0 + kTile, view_.size.height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const Hit hit = cast(pixel, candidates);
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.size.width) +
                      static_cast<std::size_t>(x);
      image_.distance[at] = static_cast<double>(hit.distance);
      image_.hits.distance[at] = static_cast<float>(hit.distance);
      image_.hits.normal[at] = glm::vec3(hit.normal);
      image_.hits.id[at] = hit.id;
      image_.grazing[at] = options_.grazing && grazing(hit, pixel, candidates) ? 1 : 0;
    }
  }
}

void QuadricTracer::trace() {
  const int tilesX = (view_.size.width + kTile - 1) / kTile, tilesY = (view_.size.height + kTile - 1) / kTile;
  tbb::parallel_for(0, tilesX * tilesY,
                    [&](int tile) { traceTile(tile % tilesX * kTile, tile / tilesX * kTile); });
}

}  // namespace

ReferenceImage traceQuadrics(const Primitives& primitives, const View& view,
                             const ReferenceOptions& options) {
  const std::size_t pixels =
      static_cast<std::size_t>(view.size.width) * static_cast<std::size_t>(view.size.height);
  ReferenceImage image;
  image.hits.size = view.size;
  image.hits.distance.resize(pixels);
  image.hits.normal.resize(pixels);
  image.hits.id.resize(pixels);
  image.distance.resize(pixels);
  image.pieces.resize(pixels);
  image.grazing.resize(pixels);
  QuadricTracer(primitives, view, options, image).trace();
  return image;
}

ReferenceImage traceScene(const Primitives& primitives, const View& view, const ReferenceOptions& options) {
  if (primitives.surfaces.empty()) return traceQuadrics(primitives, view, options);
  ReferenceImage image = traceReference(primitives.surfaces, primitives.origin, view, options);
  if (primitives.noQuadrics()) return image;
  const ReferenceImage other = traceQuadrics(primitives, view, options);
  for (std::size_t i = 0; i < image.distance.size(); ++i) {
    const bool nearer = other.distance[i] < image.distance[i];
    if (nearer) {
      image.distance[i] = other.distance[i];
      image.hits.distance[i] = other.hits.distance[i];
      image.hits.normal[i] = other.hits.normal[i];
      image.hits.id[i] = other.hits.id[i];
    }
    if (other.grazing[i] != 0) image.grazing[i] = 1;
  }
  return image;
}

}  // namespace meniscus

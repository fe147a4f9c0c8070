#include "core/bvh/solid_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/bvh/tree_walk.h"
#include "core/shared_math.h"

namespace meniscus::bvh {

namespace {

// A chord that ends so soon after the ray's beginning [Å] belongs to what the ray begins on: stored numbers
// are float32, so a cylinder's side and the ball at its end meet no better.
constexpr double kAtStart = 1e-5;

Box boxOf(const SpherePrimitive& s) {
  return {s.center - s.radius, s.center + s.radius};
}

Box boxOf(const CylinderPrimitive& c) {
  const glm::vec3 axis = c.b - c.a;
  const float length2 = glm::dot(axis, axis);
  // A disc's extent along an axis is the radius times the sine of the angle to its normal.
  glm::vec3 reach(c.radius);
  if (length2 > 0) reach *= glm::sqrt(glm::max(1.0f - axis * axis / length2, 0.0f));
  return {glm::min(c.a, c.b) - reach, glm::max(c.a, c.b) + reach};
}

struct EllipsoidAxes {
  glm::dvec3 u, v, w, radii;
};
EllipsoidAxes axesOf(const EllipsoidPrimitive& e) {
  const glm::dvec3 a(e.axisA), b(e.axisB);
  const glm::dvec3 u = glm::normalize(a), w = glm::normalize(glm::cross(a, b));
  return {u, glm::cross(w, u), w, {glm::length(a), glm::length(b), static_cast<double>(e.shortest)}};
}

Box boxOf(const EllipsoidPrimitive& e) {
  const EllipsoidAxes axes = axesOf(e);
  const glm::dvec3 a = axes.u * axes.radii.x, b = axes.v * axes.radii.y, c = axes.w * axes.radii.z;
  const glm::vec3 reach(glm::sqrt(a * a + b * b + c * c));
  return {e.center - reach, e.center + reach};
}

}  // namespace

SolidTracer::SolidTracer(const Primitives& primitives)
    : primitives_(primitives),
      cylinders_(static_cast<std::uint32_t>(primitives.spheres.size())),
      ellipsoids_(cylinders_ + static_cast<std::uint32_t>(primitives.cylinders.size())),
      triangles_(ellipsoids_ + static_cast<std::uint32_t>(primitives.ellipsoids.size())) {
  std::vector<Box> boxes;
  const auto add = [&](std::uint32_t solid, const Box& box) {
    const glm::vec3 size = glm::max(glm::abs(box.low), glm::abs(box.high));
    boxes.push_back(box.grown(1e-6f * std::max({size.x, size.y, size.z})));
    solids_.push_back(solid);
  };
  for (std::uint32_t i = 0; i < primitives.spheres.size(); ++i)
    if (primitives.spheres[i].radius > 0) add(i, boxOf(primitives.spheres[i]));
  for (std::uint32_t i = 0; i < primitives.cylinders.size(); ++i) {
    const CylinderPrimitive& c = primitives.cylinders[i];
    if (c.radius > 0 && c.a != c.b) add(cylinders_ + i, boxOf(c));
  }
  for (std::uint32_t i = 0; i < primitives.ellipsoids.size(); ++i)
    if (primitives.ellipsoids[i].shortest > 0) add(ellipsoids_ + i, boxOf(primitives.ellipsoids[i]));
  for (std::uint32_t i = 0; i < primitives.mesh.triangles.size(); ++i) {
    const TriangleCorners& t = primitives.mesh.triangles[i];
    Box box;
    for (const std::uint32_t corner : {t.a, t.b, t.c}) {
      const glm::vec3& p = primitives.mesh.vertices[corner].position;
      box.add({p, p});
    }
    add(triangles_ + i, box);
  }
  tree_ = buildBoxTree(boxes, LeafCost::linear);
}

SolidTracer::Found SolidTracer::meetTriangle(const TriangleCorners& corners, const FieldRay& ray) const {
  // Möller and Trumbore 1997, doi 10.1080/10867651.1997.10487468; from both sides.
  const auto& vertices = primitives_.mesh.vertices;
  const glm::dvec3 a(vertices[corners.a].position);
  const glm::dvec3 ab = glm::dvec3(vertices[corners.b].position) - a;
  const glm::dvec3 ac = glm::dvec3(vertices[corners.c].position) - a;
  const glm::dvec3 p = glm::cross(ray.direction, ac);
  const double volume = glm::dot(ab, p);
  if (volume == 0) return {};
  const glm::dvec3 from = ray.origin - a;
  const double u = glm::dot(from, p) / volume;
  const glm::dvec3 q = glm::cross(from, ab);
  const double v = glm::dot(ray.direction, q) / volume;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return {};
  const double distance = glm::dot(ac, q) / volume;
  if (!(distance > ray.from + (ray.from > 0 ? 0 : kAtStart) && distance < ray.to)) return {};
  return {distance, glm::normalize(glm::cross(ab, ac)), volume < 0};
}

SolidTracer::Found SolidTracer::meet(std::uint32_t solid, const FieldRay& ray) const {
  if (solid >= triangles_) return meetTriangle(primitives_.mesh.triangles[solid - triangles_], ray);
  f64::Chord chord;
  glm::dvec3 center;
  if (solid < cylinders_) {
    const SpherePrimitive& s = primitives_.spheres[solid];
    center = glm::dvec3(s.center);
    chord = f64::sphereChord(ray.origin - center, ray.direction, static_cast<double>(s.radius));
  } else if (solid < ellipsoids_) {
    const CylinderPrimitive& c = primitives_.cylinders[solid - cylinders_];
    const glm::dvec3 a(c.a), b(c.b);
    center = (a + b) / 2.0;
    const double length = glm::length(b - a);
    chord = f64::cylinderChord(ray.origin - center, ray.direction, (b - a) / length, length / 2,
                               static_cast<double>(c.radius));
  } else {
    const EllipsoidPrimitive& e = primitives_.ellipsoids[solid - ellipsoids_];
    center = glm::dvec3(e.center);
    const EllipsoidAxes axes = axesOf(e);
    chord = f64::ellipsoidChord(ray.origin - center, ray.direction, axes.u, axes.v, axes.w, axes.radii);
  }
  if (!chord.hit) return {};
  const auto along = [&](const glm::dvec3& point) {
    return glm::dot(point + center - ray.origin, ray.direction);
  };
  const double in = along(chord.entry), out = along(chord.exit);
  const double start = ray.from + (ray.from > 0 ? 0 : kAtStart);
  if (in >= ray.from && in <= ray.to && out > start) return {in, chord.entryNormal, false};
  if (in < ray.from && out > start && out <= ray.to) return {out, chord.exitNormal, true};
  return {};
}

double SolidTracer::distance(const FieldRay& ray, std::uint32_t except, bool any, TraceCounts& counts) const {
  double nearest = kInfinity;
  walk(tree_, WalkRay(ray.origin, ray.direction), ray.from, ray.to, counts.nodes,
       [&](const Node& node, double, double, double limit) {
         for (std::uint32_t k = 0; k < node.count; ++k) {
           const std::uint32_t solid = solids_[tree_.members[node.first + k]];
           if (solid != except) nearest = std::min(nearest, meet(solid, ray).distance);
           if (any && nearest < kInfinity) return -kInfinity;
         }
         return std::min(limit, nearest);
       });
  return nearest;
}

double SolidTracer::distance(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const {
  return distance(ray, except, false, counts);
}

bool SolidTracer::blocked(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const {
  return distance(ray, except, true, counts) < kInfinity;
}

SolidHit SolidTracer::cast(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const {
  SolidHit hit;
  walk(tree_, WalkRay(ray.origin, ray.direction), ray.from, ray.to, counts.nodes,
       [&](const Node& node, double, double, double limit) {
         for (std::uint32_t k = 0; k < node.count; ++k) {
           const std::uint32_t solid = solids_[tree_.members[node.first + k]];
           if (solid == except) continue;
           const Found found = meet(solid, ray);
           const bool first =
               found.distance < hit.distance || (found.distance == hit.distance && solid < hit.solid);
           if (!(found.distance < kInfinity) || !first) continue;
           hit.distance = found.distance;
           hit.normal = found.normal;
           hit.fromInside = found.fromInside;
           hit.solid = solid;
         }
         return std::min(limit, hit.distance);
       });
  if (hit) describe(ray, hit);
  return hit;
}

void SolidTracer::describe(const FieldRay& ray, SolidHit& hit) const {
  hit.point = ray.origin + hit.distance * ray.direction;
  if (hit.solid < cylinders_) {
    const SpherePrimitive& s = primitives_.spheres[hit.solid];
    hit.color = s.color;
    hit.id = s.id;
  } else if (hit.solid < ellipsoids_) {
    const CylinderPrimitive& c = primitives_.cylinders[hit.solid - cylinders_];
    const glm::dvec3 middle = (glm::dvec3(c.a) + glm::dvec3(c.b)) / 2.0;
    const bool second = glm::dot(hit.point - middle, glm::dvec3(c.b - c.a)) > 0;
    hit.color = second ? c.colorB : c.colorA;
    hit.id = second ? c.idB : c.idA;
  } else if (hit.solid < triangles_) {
    const EllipsoidPrimitive& e = primitives_.ellipsoids[hit.solid - ellipsoids_];
    hit.color = e.color;
    hit.id = e.id;
  } else {
    describeTriangle(primitives_.mesh.triangles[hit.solid - triangles_], hit);
    const TriangleSurface& surface = primitives_.mesh.surfaces[hit.solid - triangles_];
    hit.color = surface.color;
    hit.id = surface.id;
  }
}

// The point is lifted to where the corners' tangent planes say that the smooth surface is, or rays that begin
// on a facet would be hidden by its neighbours (J. Hanika, Hacking the Shadow Terminator, Ray Tracing Gems
// II, 2021, ch. 4, doi 10.1007/978-1-4842-7185-8_4).
void SolidTracer::describeTriangle(const TriangleCorners& corners, SolidHit& hit) const {
  const std::uint32_t of[] = {corners.a, corners.b, corners.c};
  const auto position = [&](int i) { return glm::dvec3(primitives_.mesh.vertices[of[i]].position); };
  const glm::dvec3 across = glm::cross(position(1) - position(0), position(2) - position(0));
  const double area2 = glm::dot(across, across);
  glm::dvec3 lift(0.0), normal(0.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 b = position((i + 1) % 3), c = position((i + 2) % 3);
    const double weight = glm::dot(glm::cross(b - hit.point, c - hit.point), across) / area2;
    const glm::dvec3 n(primitives_.mesh.vertices[of[i]].normal);
    lift -= weight * std::min(glm::dot(hit.point - position(i), n), 0.0) * n;
    normal += weight * n;
  }
  hit.point += lift;
  hit.normal = glm::normalize(normal);
}

}  // namespace meniscus::bvh

#include "core/tiles/quadric_source.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

namespace meniscus::tiles {

namespace {

// Bytes R, G, B, 255.
std::uint32_t packAlbedo(std::uint32_t color) {
  return 0xFF000000u | (color & 0xFFu) << 16 | (color & 0xFF00u) | (color >> 16 & 0xFFu);
}

void store(float (&out)[3], const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i]);
}

glm::dvec3 thirdAxis(const EllipsoidPrimitive& e) {
  return glm::normalize(glm::cross(glm::dvec3(e.axisA), glm::dvec3(e.axisB))) *
         static_cast<double>(e.shortest);
}

Clusters::Ball ballOf(const Quadrics& quadrics, std::size_t index) {
  const std::size_t spheres = quadrics.spheres.size(), rods = quadrics.cylinders.size();
  if (index < spheres) {
    const SpherePrimitive& s = quadrics.spheres[index];
    return {s.center, s.radius > 0 ? s.radius : -1};
  }
  if (index < spheres + rods) {
    const CylinderPrimitive& c = quadrics.cylinders[index - spheres];
    return {0.5f * (c.a + c.b), 0.5f * glm::length(c.b - c.a) + c.radius};
  }
  const EllipsoidPrimitive& e = quadrics.ellipsoids[index - spheres - rods];
  return {e.center, std::max({glm::length(e.axisA), glm::length(e.axisB), e.shortest})};
}

}  // namespace

Clusters clustersOf(const Primitives& primitives) {
  Clusters clusters;
  if (!Clusters::worthwhile(primitives.counts().all())) return clusters;
  forSets(primitives, [&](const Quadrics& quadrics, std::span<const QuadricCopy> copies) {
    std::vector<RigidMotion> motions;
    for (const QuadricCopy& copy : copies) motions.push_back(copy.motion);
    clusters.add(
        quadrics.quadricCount(), [&](std::size_t index) { return ballOf(quadrics, index); }, motions);
  });
  return clusters;
}

QuadricSource::QuadricSource(const Primitives& primitives, const TileTarget& target) : projection_(target) {
  forSets(primitives, [&](const Quadrics& quadrics, std::span<const QuadricCopy> copies) {
    sets_.push_back({&quadrics, copies, size_});
    size_ += quadrics.quadricCount() * copies.size();
  });
}

const QuadricSource::Set& QuadricSource::setOf(std::size_t index) const {
  if (sets_.size() == 1) return sets_.front();
  return *std::prev(std::upper_bound(sets_.begin(), sets_.end(), index,
                                     [](std::size_t i, const Set& set) { return i < set.first; }));
}

QuadricSource::Placed QuadricSource::at(std::size_t index) const {
  const Set& set = setOf(index);
  const Quadrics& q = *set.quadrics;
  const std::size_t inSet = index - set.first, count = q.quadricCount();
  const std::size_t copy = set.copies.size() == 1 ? 0 : inSet / count;
  std::size_t i = inSet - copy * count;
  Placed placed;
  placed.copy = &set.copies[copy];
  if (i < q.spheres.size()) {
    placed.sphere = &q.spheres[i];
  } else if (i -= q.spheres.size(); i < q.cylinders.size()) {
    placed.cylinder = &q.cylinders[i];
  } else {
    placed.ellipsoid = &q.ellipsoids[i - q.cylinders.size()];
  }
  return placed;
}

bool QuadricSource::isBall(std::size_t index) const {
  return at(index).sphere != nullptr;
}

void QuadricSource::prefetch(std::size_t index) const {
  const Placed q = at(index);
  if (q.sphere) {
    hwy::Prefetch(q.sphere);
  } else if (q.cylinder) {
    hwy::Prefetch(q.cylinder);
  } else {
    hwy::Prefetch(q.ellipsoid);
  }
}

Placement QuadricSource::place(std::size_t index) const {
  const Placed q = at(index);
  const RigidMotion& motion = q.copy->motion;
  if (q.sphere)
    return projection_.placeSphere(motion(q.sphere->center), static_cast<double>(q.sphere->radius));
  if (q.cylinder)
    return projection_.placeCylinder(motion(q.cylinder->a), motion(q.cylinder->b),
                                     static_cast<double>(q.cylinder->radius));
  const EllipsoidPrimitive& e = *q.ellipsoid;
  const glm::dmat3& turn = motion.turn;
  return projection_.placeEllipsoid(
      motion(e.center), {turn * glm::dvec3(e.axisA), turn * glm::dvec3(e.axisB), turn * thirdAxis(e)});
}

Occluder QuadricSource::occluder(std::size_t index) const {
  const Placed q = at(index);
  const RigidMotion& motion = q.copy->motion;
  if (q.sphere) return projection_.occluder(motion(q.sphere->center), static_cast<double>(q.sphere->radius));
  if (q.cylinder) return {};  // rarely as wide as a tile
  const EllipsoidPrimitive& e = *q.ellipsoid;
  return projection_.occluder(motion(e.center),
                              static_cast<double>(std::min(glm::length(e.axisB), e.shortest)));
}

void QuadricSource::record(std::size_t index, QuadricRecord& out) const {
  const Placed q = at(index);
  const RigidMotion& motion = q.copy->motion;
  const auto turn = [&](const glm::dvec3& v) { return projection_.turn(motion.turn * v); };
  out = {};
  out.lowY = -std::numeric_limits<float>::infinity();
  out.highY = std::numeric_limits<float>::infinity();
  glm::dvec3 center, along;  // along: from a cylinder's one end to the other
  double size = 0, reach = 0;
  if (q.sphere) {
    const SpherePrimitive& s = *q.sphere;
    out.kind = QuadricKind::sphere;
    center = s.center;
    size = reach = static_cast<double>(s.radius);
    out.radius = s.radius;
    out.albedo[0] = out.albedo[1] = packAlbedo(s.color);
    out.id[0] = out.id[1] = s.id;
  } else if (q.cylinder) {
    const CylinderPrimitive& c = *q.cylinder;
    out.kind = QuadricKind::cylinder;
    center = 0.5 * (glm::dvec3(c.a) + glm::dvec3(c.b));
    along = turn(glm::dvec3(c.b) - glm::dvec3(c.a));
    const double length = glm::length(along);
    out.radius = c.radius;
    out.radii[0] = static_cast<float>(0.5 * length);
    store(out.axisU, along / length);
    size = static_cast<double>(c.radius) + 0.5 * length;
    reach = static_cast<double>(c.radius) + 0.5 * std::abs(along.z);
    out.albedo[0] = packAlbedo(c.colorA);
    out.albedo[1] = packAlbedo(c.colorB);
    out.id[0] = c.idA;
    out.id[1] = c.idB;
  } else {
    const EllipsoidPrimitive& e = *q.ellipsoid;
    out.kind = QuadricKind::ellipsoid;
    center = e.center;
    const glm::dvec3 a = turn(e.axisA), b = turn(e.axisB);
    const glm::dvec3 u = glm::normalize(a), v = glm::normalize(b), w = glm::cross(u, v);
    store(out.axisU, u);
    store(out.axisV, v);
    store(out.axisW, w);
    store(out.radii, {glm::length(a), glm::length(b), static_cast<double>(e.shortest)});
    size = glm::length(a);
    reach = glm::length(glm::dvec3(a.z, b.z, w.z * static_cast<double>(e.shortest)));
    out.albedo[0] = out.albedo[1] = packAlbedo(e.color);
    out.id[0] = out.id[1] = e.id;
  }
  for (std::uint32_t& id : out.id) id += q.copy->idShift;
  const ProjectedPoint p = projection_.project(motion(center));
  out.pixelX = p.pixel.x;
  out.pixelY = p.pixel.y;
  out.perPixel = static_cast<float>(projection_.perPixel(p));
  out.centerX = static_cast<float>(p.view.x);
  out.centerY = static_cast<float>(p.view.y);
  out.centerZ = static_cast<float>(p.view.z);
  out.eyeAbove = static_cast<float>(projection_.eyeZ() - p.view.z);
  const double spare = 1e-6 * (std::abs(p.view.z) + 2 * reach);
  out.front = static_cast<float>(p.view.z + reach + spare);
  if (q.cylinder) {
    projection_.rowsOf(p, along, static_cast<double>(q.cylinder->radius), out.lowY, out.highY);
  } else {
    projection_.rowsOf(p, static_cast<float>(size), out.lowY, out.highY);
  }
  const double range = projection_.range(p);
  out.rangeHi = static_cast<float>(range);
  out.rangeLo = static_cast<float>(range - static_cast<double>(out.rangeHi));
  out.fromEye = projection_.nearEye(p, size) ? 1u : 0u;
  out.meetsNear = p.view.z + reach * (1 + 1e-5) >= static_cast<double>(projection_.nearZ()) ? 1u : 0u;
}

}  // namespace meniscus::tiles

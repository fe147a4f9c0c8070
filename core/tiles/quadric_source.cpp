#include "core/tiles/quadric_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
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

}  // namespace

std::size_t QuadricSource::size() const {
  return primitives_.spheres.size() + primitives_.cylinders.size() + primitives_.ellipsoids.size();
}

Placement QuadricSource::place(std::size_t index) const {
  const std::size_t spheres = primitives_.spheres.size(), rods = primitives_.cylinders.size();
  if (index < spheres) {
    const SpherePrimitive& s = primitives_.spheres[index];
    return projection_.placeSphere(s.center, static_cast<double>(s.radius));
  }
  if (index < spheres + rods) {
    const CylinderPrimitive& c = primitives_.cylinders[index - spheres];
    return projection_.placeCylinder(c.a, c.b, static_cast<double>(c.radius));
  }
  const EllipsoidPrimitive& e = primitives_.ellipsoids[index - spheres - rods];
  return projection_.placeEllipsoid(e.center, {e.axisA, e.axisB, thirdAxis(e)});
}

Clusters clustersOf(const Primitives& primitives) {
  const std::size_t spheres = primitives.spheres.size(), rods = primitives.cylinders.size();
  Clusters clusters;
  clusters.build(spheres + rods + primitives.ellipsoids.size(), [&](std::size_t index) -> Clusters::Ball {
    if (index < spheres) {
      const SpherePrimitive& s = primitives.spheres[index];
      return {s.center, s.radius > 0 ? s.radius : -1};
    }
    if (index < spheres + rods) {
      const CylinderPrimitive& c = primitives.cylinders[index - spheres];
      return {0.5f * (c.a + c.b), 0.5f * glm::length(c.b - c.a) + c.radius};
    }
    const EllipsoidPrimitive& e = primitives.ellipsoids[index - spheres - rods];
    return {e.center, std::max({glm::length(e.axisA), glm::length(e.axisB), e.shortest})};
  });
  return clusters;
}

Occluder QuadricSource::occluder(std::size_t index) const {
  const std::size_t spheres = primitives_.spheres.size(), rods = primitives_.cylinders.size();
  if (index < spheres) {
    const SpherePrimitive& s = primitives_.spheres[index];
    return projection_.occluder(s.center, static_cast<double>(s.radius));
  }
  if (index < spheres + rods) return {};  // rarely as wide as a tile
  const EllipsoidPrimitive& e = primitives_.ellipsoids[index - spheres - rods];
  return projection_.occluder(e.center, static_cast<double>(std::min(glm::length(e.axisB), e.shortest)));
}

void QuadricSource::record(std::size_t index, QuadricRecord& out) const {
  const std::size_t spheres = primitives_.spheres.size(), rods = primitives_.cylinders.size();
  out = {};
  out.lowY = -std::numeric_limits<float>::infinity();
  out.highY = std::numeric_limits<float>::infinity();
  glm::dvec3 center;
  double size = 0, reach = 0;
  if (index < spheres) {
    const SpherePrimitive& s = primitives_.spheres[index];
    out.kind = QuadricKind::sphere;
    center = s.center;
    size = reach = static_cast<double>(s.radius);
    out.radius = s.radius;
    out.albedo[0] = out.albedo[1] = packAlbedo(s.color);
    out.id[0] = out.id[1] = s.id;
  } else if (index < spheres + rods) {
    const CylinderPrimitive& c = primitives_.cylinders[index - spheres];
    out.kind = QuadricKind::cylinder;
    center = 0.5 * (glm::dvec3(c.a) + glm::dvec3(c.b));
    const glm::dvec3 along = projection_.turn(glm::dvec3(c.b) - glm::dvec3(c.a));
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
    const EllipsoidPrimitive& e = primitives_.ellipsoids[index - spheres - rods];
    out.kind = QuadricKind::ellipsoid;
    center = e.center;
    const glm::dvec3 a = projection_.turn(e.axisA), b = projection_.turn(e.axisB);
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
  const ProjectedPoint p = projection_.project(center);
  out.pixelX = p.pixel.x;
  out.pixelY = p.pixel.y;
  out.perPixel = static_cast<float>(projection_.perPixel(p));
  out.centerX = static_cast<float>(p.view.x);
  out.centerY = static_cast<float>(p.view.y);
  out.centerZ = static_cast<float>(p.view.z);
  out.eyeAbove = static_cast<float>(projection_.eyeZ() - p.view.z);
  out.front = static_cast<float>(p.view.z + reach);
  if (out.kind == QuadricKind::sphere) projection_.rowsOf(p, out.radius, out.lowY, out.highY);
  const double range = projection_.range(p);
  out.rangeHi = static_cast<float>(range);
  out.rangeLo = static_cast<float>(range - static_cast<double>(out.rangeHi));
  out.fromEye = projection_.nearEye(p, size) ? 1u : 0u;
  out.meetsNear = p.view.z + reach * (1 + 1e-5) >= static_cast<double>(projection_.nearZ()) ? 1u : 0u;
}

}  // namespace meniscus::tiles

#include "tests/support/scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/exact_rays.h"
#include "tests/support/random.h"

namespace meniscus::test {

std::shared_ptr<Primitives> randomSpheres(int count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> unit(-1, 1), radius(1, 2);
  std::uniform_int_distribution<std::uint32_t> color(0, 0xFFFFFF);
  const float extent = 1.6f * std::cbrt(static_cast<float>(count));
  auto out = std::make_shared<Primitives>();
  out->origin = {31.5, -12.25, 1000.125};
  while (out->spheres.size() < static_cast<std::size_t>(count)) {
    const glm::vec3 p(unit(engine), unit(engine), unit(engine));
    if (glm::length(p) > 1) continue;
    const auto id = static_cast<std::uint32_t>(out->spheres.size() + 1);
    out->spheres.push_back({p * extent, radius(engine), color(engine), id});
  }
  return out;
}

std::shared_ptr<Primitives> randomChain(int count, unsigned seed) {
  auto out = randomSpheres(count, seed);
  for (SpherePrimitive& s : out->spheres) s.radius *= 0.25f;
  for (std::size_t i = 0; i + 1 < out->spheres.size(); ++i) {
    const SpherePrimitive &a = out->spheres[i], &b = out->spheres[i + 1];
    out->cylinders.push_back({a.center, 0.15f, b.center, a.color, b.color, a.id, b.id});
  }
  return out;
}

std::shared_ptr<Primitives> randomEllipsoids(int count, unsigned seed, double share) {
  auto out = randomSpheres(count, seed);
  Random random(seed);
  for (const SpherePrimitive& s : out->spheres) {
    const glm::dmat3 turn = glm::mat3_cast(random.rotation());
    const auto radius = static_cast<double>(s.radius);
    const double middle = radius * random.uniform(share, 1);
    const double shortest = share == 1 ? radius : random.uniform(share * radius, middle);
    out->ellipsoids.push_back({s.center, static_cast<float>(shortest), glm::vec3(turn[0] * radius),
                               glm::vec3(turn[1] * middle), s.color, s.id});
  }
  out->spheres.clear();
  return out;
}

View viewOf(const Primitives& primitives, ImageSize size, Projection projection, double fovY) {
  std::vector<FitSphere> fit;
  for (const SpherePrimitive& s : primitives.spheres) {
    fit.push_back({primitives.origin + glm::dvec3(s.center), static_cast<double>(s.radius)});
  }
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) {
    fit.push_back({primitives.origin + glm::dvec3(e.center), static_cast<double>(glm::length(e.axisA))});
  }
  Camera camera;
  camera.projection = projection;
  camera.fovY = fovY;
  camera.orientation = rotatedBy({1, 0, 0, 0}, {25, -40, 10});
  return makeView(fitted(camera, size, fit), size, primitives.bounds());
}

namespace {

// Keeps the nearest and the next of what a ray meets.
class Nearest {
 public:
  explicit Nearest(Real start) : start_(start) {}
  void add(const std::optional<ExactChord>& chord, std::uint32_t idIn, std::uint32_t idOut) {
    if (!chord) return;
    const bool inside = chord->in < start_;
    const Real t = inside ? chord->out : chord->in;
    if (t < start_) return;
    const std::uint32_t id = inside ? idOut : idIn;
    if (t < best) {
      if (bestId != id) next = best;
      best = t;
      bestId = id;
    } else if (id != bestId && t < next) {
      next = t;
    }
  }
  Real best = std::numeric_limits<Real>::infinity(), next = best;
  std::uint32_t bestId = 0;

 private:
  Real start_;
};

}  // namespace

ExactHit exactHit(const Primitives& primitives, const View& view, glm::dvec2 pixel, double margin) {
  const ExactRay ray = exactRay(view, pixel);
  const Real start = (Real(view.nearZ) - ray.origin.z) / ray.direction.z;
  Nearest nearest(start);
  std::vector<std::pair<Real, Real>>
      margins;  // how nearly something is grazed, and from which distance on it matters
  for (const SpherePrimitive& s : primitives.spheres) {
    const Vec3 center = exactViewPoint(view, primitives.origin, s.center);
    nearest.add(exactSphere(ray, center, Real(s.radius)), s.id, s.id);
    const Real along = glm::dot(center - ray.origin, ray.direction);
    const Real closest = glm::length(center - ray.origin - along * ray.direction);
    margins.emplace_back(std::abs(closest - Real(s.radius)), along - Real(s.radius));
  }
  for (const CylinderPrimitive& c : primitives.cylinders) {
    const Vec3 a = exactViewPoint(view, primitives.origin, c.a),
               b = exactViewPoint(view, primitives.origin, c.b);
    const auto chord = exactCylinder(ray, a, b, Real(c.radius));
    const Vec3 axis = glm::normalize(b - a), middle = (a + b) * Real(0.5);
    const auto half = [&](Real t) {
      return glm::dot(ray.origin + t * ray.direction - middle, axis) > 0 ? c.idB : c.idA;
    };
    if (chord) nearest.add(chord, half(chord->in), half(chord->out));
    // Grazing: a slightly larger or smaller cylinder decides otherwise.
    const Real d = Real(margin);
    const Vec3 stretch = axis * d;
    const bool larger = exactCylinder(ray, a - stretch, b + stretch, Real(c.radius) + d).has_value();
    const bool smaller = exactCylinder(ray, a + stretch, b - stretch, Real(c.radius) - d).has_value();
    const Real along = glm::dot(middle - ray.origin, ray.direction);
    if (larger != smaller) margins.emplace_back(Real(0), along - glm::length(b - a) - Real(c.radius));
    if (chord) {  // the border between the halves
      const Real t = chord->in < start ? chord->out : chord->in;
      margins.emplace_back(std::abs(glm::dot(ray.origin + t * ray.direction - middle, axis)), t);
    }
  }
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) {
    const ExactEllipsoid exact = exactEllipsoid(view, primitives.origin, e);
    nearest.add(exactEllipsoidChord(ray, exact), e.id, e.id);
    ExactEllipsoid larger = exact, smaller = exact;
    larger.radii += Vec3(Real(margin));
    smaller.radii -= Vec3(Real(margin));
    const bool none = std::min({smaller.radii.x, smaller.radii.y, smaller.radii.z}) <= 0;
    const bool grazed = exactEllipsoidChord(ray, larger).has_value() !=
                        (!none && exactEllipsoidChord(ray, smaller).has_value());
    const Real along = glm::dot(exact.center - ray.origin, ray.direction);
    if (grazed) margins.emplace_back(Real(0), along - exact.radii.x);
  }
  ExactHit hit;
  hit.id = nearest.bestId;
  hit.distance = static_cast<double>(nearest.best);
  hit.runnerUp = static_cast<double>(nearest.next);
  Real clearance = std::numeric_limits<Real>::infinity();
  for (const auto& [distance, from] : margins) {
    if (from <= nearest.best + 1) clearance = std::min(clearance, distance);
  }
  hit.clearance = static_cast<double>(clearance);
  return hit;
}

}  // namespace meniscus::test

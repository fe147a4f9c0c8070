#pragma once
// All places where a ray crosses a metaball surface, in double precision, by the truth's own arithmetic
// (core/reference_ray.h): one after the other, each looked for behind the one before.

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "core/reference_ray.h"
#include "core/view.h"

namespace meniscus::test {

struct AllRoots {
  std::vector<double> distances;  ///< along the unit ray, as in HitImage, ascending
  bool touched = false;           ///< F came so near to zero somewhere that its sign could not be decided
};

inline AllRoots allRoots(const MetaballField& field, const glm::dvec3& origin, const View& view,
                         glm::dvec2 pixel) {
  const Ray ray = rayThrough(view, pixel);
  reference::ViewRay r;
  r.direction = ray.direction;
  r.distance0 = -glm::dot(ray.origin, ray.direction);
  r.base = ray.origin + r.distance0 * ray.direction;
  r.start = (view.nearZ - r.base.z) / r.direction.z;
  std::vector<reference::ViewBall> balls;
  for (std::size_t i = 0; i < field.balls.size(); ++i) {
    reference::ViewBall ball;
    ball.center = view.rotation * ((origin - view.pivot) + glm::dvec3(field.balls[i].center));
    ball.support = static_cast<double>(field.balls[i].support);
    ball.coefficient = static_cast<double>(field.balls[i].coefficient);
    ball.nearest = glm::dot(ball.center - ray.origin, ray.direction) - ball.support;
    ball.index = static_cast<std::uint32_t>(i);
    balls.push_back(ball);
  }
  std::vector<std::uint32_t> order(balls.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return balls[a].nearest < balls[b].nearest; });
  AllRoots roots;
  reference::RayScratch scratch;
  while (true) {
    const reference::RayHit hit =
        reference::castRay(field, balls, order, r, false, std::numeric_limits<double>::infinity(), scratch);
    roots.touched = roots.touched || hit.touched;
    if (hit.verdict != reference::Verdict::hit) return roots;
    if (roots.distances.empty() || hit.distance > roots.distances.back() + 1e-7)
      roots.distances.push_back(hit.distance);
    r.start = hit.distance - r.distance0 + 1e-9;
  }
}

}  // namespace meniscus::test

#include "core/bvh/field_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/bvh/tree_walk.h"

namespace meniscus::bvh {

void TraceCounts::add(const TraceCounts& other) {
  rays += other.rays;
  nodes += other.nodes;
  leaves += other.leaves;
  balls += other.balls;
  effort.pieces += other.effort.pieces;
  effort.iterations += other.effort.iterations;
  effort.grazing += other.effort.grazing;
  effort.notConverged += other.effort.notConverged;
}

FieldTracer::FieldTracer(const MetaballField& field, const FieldTree& tree, Search search)
    : field_(field), tree_(tree), search_(search) {
  balls_.reserve(field.balls.size());
  for (const Metaball& ball : field.balls) {
    const double support = static_cast<double>(ball.support);
    balls_.push_back({glm::dvec3(ball.center), support * support, 1 / (support * support),
                      static_cast<double>(ball.coefficient), ball.color, ball.id});
  }
}

void FieldTracer::addChord(const FieldRay& ray, std::uint32_t ball, bool own, double from, double to,
                           RayScratch& scratch) const {
  const mesh::WideBall& b = balls_[ball];
  const glm::dvec3 toCenter = b.center - ray.origin;
  const double middle = glm::dot(toCenter, ray.direction);
  const glm::dvec3 aside = toCenter - middle * ray.direction;
  const double half2 = b.support2 - glm::dot(aside, aside);
  if (!(half2 > 0)) return;
  const double half = std::sqrt(half2);
  const double begin = std::max(from, middle - half), end = std::min(to, middle + half);
  if (begin < end) scratch.chords.push_back({middle, half2, b.inverse2, b.coefficient, begin, end, own});
}

double FieldTracer::search(const Stretch& stretch, RayScratch& scratch, TraceCounts& counts) const {
  return search_ == Search::guaranteed
             ? firstCrossing(field_.kernel, field_.level, stretch, scratch, counts.effort)
             : firstProjection(field_.kernel, field_.level, stretch, scratch, counts.effort);
}

// Leaves of a classical tree do not know what is around them: all balls that the ray meets, then all roots.
FieldHit FieldTracer::castGathered(const FieldRay& ray, bool inside, RayScratch& scratch,
                                   TraceCounts& counts) const {
  scratch.chords.clear();
  scratch.members.clear();
  walk(tree_, WalkRay(ray.origin, ray.direction), ray.from, ray.to, counts.nodes,
       [&](const Node& node, double, double, double limit) {
         ++counts.leaves;
         counts.balls += node.count;
         for (std::uint32_t k = 0; k < node.count; ++k)
           addChord(ray, tree_.members[node.first + k], true, ray.from, ray.to, scratch);
         return limit;
       });
  FieldHit hit;
  hit.fromInside = inside;
  hit.distance = search({ray.from, ray.to, inside, true, true}, scratch, counts);
  return hit;
}

FieldHit FieldTracer::cast(const FieldRay& ray, bool any, RayScratch& scratch, TraceCounts& counts) const {
  ++counts.rays;
  const bool inside = ray.side == Side::unknown ? this->inside(ray.origin + ray.from * ray.direction, scratch)
                                                : ray.side == Side::inside;
  if (tree_.settings.structure == Structure::classical) return castGathered(ray, inside, scratch, counts);
  const bool fitted = tree_.settings.structure == Structure::fitted;
  FieldHit hit;
  hit.fromInside = inside;
  walk(tree_, WalkRay(ray.origin, ray.direction), ray.from, ray.to, counts.nodes,
       [&](const Node& node, double from, double to, double limit) {
         ++counts.leaves;
         counts.balls += node.count;
         if (!fitted) {
           from = ray.from;
           to = limit;
         }
         scratch.chords.clear();
         for (std::uint32_t k = 0; k < node.count; ++k)
           addChord(ray, tree_.members[node.first + k], k < node.own, from, to, scratch);
         const double at = search({from, to, inside, from == ray.from, !fitted}, scratch, counts);
         if (!(at < hit.distance)) return limit;
         hit.distance = at;
         hit.leaf = static_cast<std::uint32_t>(&node - tree_.nodes.data());
         return any ? -kInfinity : at;
       });
  return hit;
}

FieldHit FieldTracer::cast(const FieldRay& ray, RayScratch& scratch, TraceCounts& counts) const {
  return cast(ray, false, scratch, counts);
}

bool FieldTracer::blocked(const FieldRay& ray, RayScratch& scratch, TraceCounts& counts) const {
  return static_cast<bool>(cast(ray, true, scratch, counts));
}

bool FieldTracer::inside(const glm::dvec3& point, RayScratch& scratch) const {
  // A node's box holds every place at which F >= 0, whose nearest leaf knows the field there.
  std::vector<std::uint32_t>& stack = scratch.members;
  stack.clear();
  if (!tree_.nodes.empty()) stack.push_back(0);
  double sum = -field_.level;
  while (!stack.empty()) {
    const Node& node = tree_.nodes[stack.back()];
    stack.pop_back();
    const glm::dvec3 low(node.box.low), high(node.box.high);
    if (!(point.x >= low.x && point.y >= low.y && point.z >= low.z && point.x <= high.x &&
          point.y <= high.y && point.z <= high.z))
      continue;
    if (!node.leaf()) {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    if (tree_.settings.structure != Structure::classical) sum = -field_.level;
    bool own = tree_.settings.structure == Structure::fitted;
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const mesh::WideBall& b = balls_[tree_.members[node.first + k]];
      const glm::dvec3 v = point - b.center;
      const double w = 1 - glm::dot(v, v) * b.inverse2;
      if (!(w > 0)) continue;
      own = own || k < node.own;
      sum += b.coefficient * mesh::fastKernel(field_.kernel, w);
    }
    if (tree_.settings.structure != Structure::classical && own && sum > 0) return true;
  }
  return tree_.settings.structure == Structure::classical && sum > 0;
}

mesh::SurfacePoint FieldTracer::surfaceAt(const FieldHit& hit, const glm::dvec3& point,
                                          RayScratch& scratch) const {
  if (tree_.settings.structure != Structure::classical) {
    const Node& node = tree_.nodes[hit.leaf];
    return mesh::surfaceAt(field_, balls_, std::span(tree_.members).subspan(node.first, node.count), point);
  }
  scratch.members.clear();
  double from = 0, to = 0;
  std::uint64_t nodes = 0;
  // Through the point only.
  walk(tree_, WalkRay(point, glm::dvec3(1, 0, 0)), from, to, nodes,
       [&](const Node& node, double, double, double limit) {
         for (std::uint32_t k = 0; k < node.count; ++k)
           scratch.members.push_back(tree_.members[node.first + k]);
         return limit;
       });
  return mesh::surfaceAt(field_, balls_, scratch.members, point);
}

}  // namespace meniscus::bvh

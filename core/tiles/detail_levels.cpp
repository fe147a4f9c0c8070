#include "core/tiles/detail_levels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>

#include "core/random.h"
#include "core/srgb.h"
#include "core/tiles/quadric_source.h"

namespace meniscus::tiles {

namespace {

// So many quadrics are looked at in a row, and a ball stands for as many at most.
constexpr int kMostLevels = 12;
constexpr std::size_t kPerTask = std::size_t{1} << kMostLevels;
constexpr double kPi = 3.14159265358979323846;
// Across the box of those that a ball stands for, where 8 touch each other [radii of a ball of their volume].
constexpr double kMostApart = 5;

// A quadric as a rod with round ends, of which a ball is the shortest.
struct Rod {
  glm::vec3 a, b;
  float radius;
  std::uint32_t colorA, colorB, idA, idB;
};

Rod rodOf(const Quadrics& quadrics, std::size_t index) {
  const std::size_t spheres = quadrics.spheres.size(), rods = quadrics.cylinders.size();
  if (index < spheres) {
    const SpherePrimitive& s = quadrics.spheres[index];
    return {s.center, s.center, s.radius, s.color, s.color, s.id, s.id};
  }
  if (index < spheres + rods) {
    const CylinderPrimitive& c = quadrics.cylinders[index - spheres];
    return {c.a, c.b, c.radius, c.colorA, c.colorB, c.idA, c.idB};
  }
  // The ball of the same volume.
  const EllipsoidPrimitive& e = quadrics.ellipsoids[index - spheres - rods];
  return {e.center, e.center, std::cbrt(glm::length(e.axisA) * glm::length(e.axisB) * e.shortest),
          e.color,  e.color,  e.id,
          e.id};
}

// On a screen that is turned any way: a quarter of the surface (Cauchy).
double meanArea(const Rod& rod) {
  const auto r = static_cast<double>(rod.radius);
  return kPi * r * (r + 0.5 * static_cast<double>(glm::distance(rod.a, rod.b)));
}

struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

  void add(const Rod& rod) {
    low = glm::min(low, glm::min(rod.a, rod.b) - rod.radius);
    high = glm::max(high, glm::max(rod.a, rod.b) + rod.radius);
  }
};

// What is in front and what is behind, along a line across two axes.
struct Ends {
  float front = -std::numeric_limits<float>::infinity(), back = std::numeric_limits<float>::infinity();
  std::uint32_t frontColor = 0, backColor = 0, id = 0;
  bool any() const { return front >= back; }

  // p: where the line meets the axes after `axis`.
  void meet(const Rod& rod, int axis, glm::vec2 p) {
    const auto across = [&](const glm::vec3& v) { return glm::vec2(v[(axis + 1) % 3], v[(axis + 2) % 3]); };
    const glm::vec2 from = across(rod.a), along = across(rod.b) - from;
    const float length2 = glm::dot(along, along);
    const float share = length2 > 0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0f, 1.0f) : 0.0f;
    const glm::vec2 off = p - (from + share * along);
    const float under = rod.radius * rod.radius - glm::dot(off, off);
    if (!(under >= 0)) return;
    const float middle = rod.a[axis] + share * (rod.b[axis] - rod.a[axis]), half = std::sqrt(under);
    const std::uint32_t color = share < 0.5f ? rod.colorA : rod.colorB;
    if (middle + half > front) {
      front = middle + half;
      frontColor = color;
      id = share < 0.5f ? rod.idA : rod.idB;
    }
    if (middle - half < back) {
      back = middle - half;
      backColor = color;
    }
  }
};

std::uint32_t storedColor(const glm::dvec3& linear) {
  std::uint32_t color = 0;
  for (int i = 0; i < 3; ++i)
    color = color << 8 | static_cast<std::uint32_t>(srgbFromLinear(linear[i]) * 255 + 0.5);
  return color;
}

// In the middle of rods, as large as what they cover together, and of the colour that they show, on average
// over both directions along each axis of their box: by points of a shifted lattice.
SpherePrimitive ballFor(std::span<const Rod> rods, const Box& box, Random& random) {
  constexpr int kPoints = 64;
  constexpr double kGolden = 0.6180339887498949;
  const auto linear = [](std::uint32_t c) {
    const auto& table = linearOfBytes();
    return glm::dvec3(table[c >> 16 & 0xFFu], table[c >> 8 & 0xFFu], table[c & 0xFFu]);
  };
  glm::dvec3 middle(0.0), color(0.0);
  double eachAlone = 0, area = 0;
  for (const Rod& rod : rods) {
    middle += meanArea(rod) * 0.5 * (glm::dvec3(rod.a) + glm::dvec3(rod.b));
    eachAlone += meanArea(rod);
  }
  std::uint32_t id = rods.front().idA;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec2 low(box.low[(axis + 1) % 3], box.low[(axis + 2) % 3]),
        size = glm::dvec2(box.high[(axis + 1) % 3], box.high[(axis + 2) % 3]) - low;
    const glm::dvec2 shift(random.uniform(0, 1), random.uniform(0, 1));
    const double share = size.x * size.y / (3 * kPoints);  // of the area, for each point
    for (int i = 0; i < kPoints; ++i) {
      const glm::vec2 p(low +
                        size * glm::fract(shift + glm::dvec2(i / static_cast<double>(kPoints), i * kGolden)));
      Ends ends;
      for (const Rod& rod : rods) ends.meet(rod, axis, p);
      if (!ends.any()) continue;
      area += share;
      color += 0.5 * share * (linear(ends.frontColor) + linear(ends.backColor));
      id = ends.id;
    }
  }
  if (!(area > 0)) color = (area = 1e-30) * linear(rods.front().colorA);
  // Together they cover no more than each by itself.
  const double radius = std::sqrt(std::min(area, eachAlone) / kPi);
  return {glm::vec3(middle / eachAlone), static_cast<float>(radius), storedColor(color / area), id};
}

// order: indices of neighbours beside each other. A ball stands for so many at most, and for none that would
// make their box larger than `mostApart` across.
std::vector<SpherePrimitive> ballsFor(const Quadrics& quadrics, std::span<const std::uint32_t> order,
                                      std::size_t perBall, double mostApart) {
  const std::size_t tasks = (order.size() + kPerTask - 1) / kPerTask;
  std::vector<std::vector<SpherePrimitive>> parts(tasks);
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    Random random(task);
    std::vector<Rod> rods;
    Box box;
    const auto close = [&] {
      if (rods.size() == 1 && rods.front().a == rods.front().b) {
        parts[task].push_back({rods.front().a, rods.front().radius, rods.front().colorA, rods.front().idA});
      } else if (!rods.empty()) {
        parts[task].push_back(ballFor(rods, box, random));
      }
      rods.clear();
    };
    for (const std::uint32_t index :
         order.subspan(task * kPerTask, std::min(kPerTask, order.size() - task * kPerTask))) {
      const Rod rod = rodOf(quadrics, index);
      Box grown = box;
      grown.add(rod);
      if (rods.size() == perBall || static_cast<double>(glm::distance(grown.low, grown.high)) > mostApart) {
        close();
        grown = {};
        grown.add(rod);
      }
      rods.push_back(rod);
      box = grown;
    }
    close();
  });
  std::vector<SpherePrimitive> balls;
  for (const std::vector<SpherePrimitive>& part : parts) balls.insert(balls.end(), part.begin(), part.end());
  return balls;
}

// How large one Å is where the scene is nearest to the eye [pixels]; infinity: it may be anywhere.
double pixelsPerUnit(const TileTarget& target, const Clusters& clusters) {
  const View& view = target.view;
  if (view.projection == Projection::orthographic) return 1 / view.pixelSize;
  double nearest = -std::numeric_limits<double>::infinity();  // z in view space
  for (const ClusterCopy& copy : clusters.copies()) {
    const Clusters::Ball& ball = clusters.sets()[copy.set].ball;
    const glm::dvec3 center = view.rotation * (copy.motion(ball.center) + target.origin - view.pivot);
    nearest = std::max(nearest, center.z + static_cast<double>(ball.radius));
  }
  const double depth = view.distance - std::min(nearest, view.nearZ);
  return depth > 0 ? 1 / (view.pixelSize * depth) : std::numeric_limits<double>::infinity();
}

}  // namespace

DetailLevels::DetailLevels(const Primitives& primitives, std::shared_ptr<const Clusters> clusters)
    : primitives_(primitives), clusters_(std::move(clusters)) {
  for (const Clusters::Ball& ball : clusters_->balls())
    largest_ = std::max(largest_, static_cast<double>(ball.radius));
}

int DetailLevels::levelFor(const TileTarget& target) {
  if (!target.thinned || clusters_->empty()) return 0;
  if (last_ && sameLists(last_->first, target)) return last_->second;
  last_ = {target, levelAt(pixelsPerUnit(target, *clusters_))};
  return last_->second;
}

int DetailLevels::levelAt(double scale) {
  const double room = std::log2(kThinnedRadius / (largest_ * scale));
  // Where they are dense, so many fill the largest ball.
  const int most = static_cast<int>(std::clamp(3 * room, 0.0, 1.0 * kMostLevels));
  int level = 0;
  double left = room;
  for (;;) {
    // Twice as many cannot cover more than twice as much. They overlap, and so there may be room for more.
    const int next = std::min(level + static_cast<int>(std::max(2 * left, 0.0)), most);
    if (next == level) return level;
    const double largest = thinned(next).largest;
    if (!(largest * scale <= kThinnedRadius)) return level;
    left = std::log2(kThinnedRadius / (largest * scale));
    level = next;
  }
}

DetailLevels::Level DetailLevels::level(int level) const {
  if (level == 0) return {&primitives_, clusters_.get()};
  const Thinned& t = thinned_.at(level);
  return {&t.primitives, &t.clusters};
}

const DetailLevels::Thinned& DetailLevels::thinned(int level) {
  const auto known = thinned_.find(level);
  return known != thinned_.end() ? known->second : thinned_.emplace(level, make(level)).first->second;
}

DetailLevels::Thinned DetailLevels::make(int level) const {
  Thinned made;
  made.primitives.origin = primitives_.origin;
  const std::size_t perBall = std::size_t{1} << level;
  const double most = kMostApart * largest_ * std::exp2(level / 3.0);
  std::size_t set = 0;
  forSets(primitives_, [&](const Quadrics& quadrics, std::span<const QuadricCopy> copies) {
    const Clusters::Set& some = clusters_->sets()[set++];
    if (some.size() == 0) return;
    const std::uint32_t first = clusters_->list()[some.first].first,
                        last = clusters_->list()[some.last - 1].last;
    std::vector<SpherePrimitive> balls =
        ballsFor(quadrics, clusters_->order().subspan(first, last - first), perBall, most);
    for (const SpherePrimitive& ball : balls)
      made.largest = std::max(made.largest, static_cast<double>(ball.radius));
    if (&quadrics == &primitives_) {
      made.primitives.spheres = std::move(balls);
    } else {
      QuadricUnit& unit = made.primitives.units.emplace_back();
      unit.spheres = std::move(balls);
      unit.copies.assign(copies.begin(), copies.end());
    }
  });
  made.clusters = clustersOf(made.primitives);
  return made;
}

std::shared_ptr<DetailLevels> levelsOf(const Primitives& primitives) {
  return std::make_shared<DetailLevels>(primitives, std::make_shared<const Clusters>(clustersOf(primitives)));
}

}  // namespace meniscus::tiles

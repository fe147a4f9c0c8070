#pragma once
// Primitives in groups of neighbours, so that what an opaque front hides is left out without touching it one
// by one. Made once for a scene, whatever it is seen from. Primitives that stand in several places are
// grouped once: a set of clusters and its copies.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/rigid_motion.h"

namespace meniscus::tiles {

inline constexpr std::size_t kClusterSize = 64;

struct Cluster {
  glm::vec3 center;           ///< in the coordinates of its set
  float radius;               ///< encloses all of its primitives
  std::uint32_t first, last;  ///< of Clusters::order()
};

/// One of the places in which a set of clusters stands.
struct ClusterCopy {
  RigidMotion motion;  ///< from the coordinates of the set to those of the scene
  std::uint32_t set;
  std::uint32_t firstPrimitive;  ///< that its primitives are numbered from, in the scene
  std::uint32_t firstCluster;    ///< likewise, in all copies before it
};

class Clusters {
 public:
  struct Ball {
    glm::vec3 center;
    float radius;  ///< of a sphere that encloses the primitive; negative or not finite: it is not drawn
  };
  struct Set {
    std::uint32_t first, last;  ///< of list()
    Ball ball;                  ///< encloses all of its clusters
    std::uint32_t size() const { return last - first; }
  };

  /// Whether so many primitives, in all copies, are worth grouping: placing few one by one costs less than
  /// the other work of a frame.
  static bool worthwhile(std::size_t primitives);
  /// Adds a set of `count` primitives and its copies, of which this is the next to number primitives from.
  /// ballOf(index) is called from several threads. Motions are rigid to 1e-5; `count` is not 0.
  void add(std::size_t count, const std::function<Ball(std::size_t)>& ballOf,
           std::span<const RigidMotion> copies);

  bool empty() const { return list_.empty(); }
  std::span<const Cluster> list() const { return list_; }
  /// Indices of primitives in their set, cluster after cluster.
  std::span<const std::uint32_t> order() const { return order_; }
  /// Of each of order(): side by side in memory, unlike the primitives.
  std::span<const Ball> balls() const { return balls_; }
  std::span<const Set> sets() const { return sets_; }
  std::span<const ClusterCopy> copies() const { return copies_; }
  /// By the number of a cluster in all copies.
  const ClusterCopy& copyOf(std::uint32_t cluster) const;
  std::uint64_t bytes() const;

 private:
  void addCopies(std::uint32_t first, const Ball& ball, std::size_t count,
                 std::span<const RigidMotion> copies);

  std::vector<std::uint32_t> order_;
  std::vector<Ball> balls_;
  std::vector<Cluster> list_;
  std::vector<Set> sets_;
  std::vector<ClusterCopy> copies_;
  std::uint32_t primitives_ = 0;  // in all copies
};

}  // namespace meniscus::tiles

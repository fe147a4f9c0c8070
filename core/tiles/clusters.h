#pragma once
// Primitives in groups of neighbours, so that what an opaque front hides is left out without touching it one
// by one. Made once for a scene, whatever it is seen from.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace meniscus::tiles {

inline constexpr std::size_t kClusterSize = 64;

struct Cluster {
  glm::vec3 center;
  float radius;               ///< encloses all of its primitives
  std::uint32_t first, last;  ///< of Clusters::order()
};

class Clusters {
 public:
  struct Ball {
    glm::vec3 center;
    float radius;  ///< of a sphere that encloses the primitive; negative or not finite: it is not drawn
  };
  /// Few primitives make no clusters. ballOf(index) is called from several threads.
  void build(std::size_t count, const std::function<Ball(std::size_t)>& ballOf);

  std::span<const Cluster> list() const { return list_; }
  /// Indices of primitives, cluster after cluster.
  std::span<const std::uint32_t> order() const { return order_; }
  /// Of each of order(): side by side in memory, unlike the primitives.
  std::span<const Ball> balls() const { return balls_; }
  std::uint64_t bytes() const;

 private:
  std::vector<std::uint32_t> order_;
  std::vector<Ball> balls_;
  std::vector<Cluster> list_;
};

}  // namespace meniscus::tiles

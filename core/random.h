#pragma once
// Seeded random numbers for generated scenes and property tests: the same on every machine and in every run.

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace meniscus {

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014, doi 10.1145/2660193.2660195); unlike the standard library's
/// distributions, whose algorithms differ between implementations.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  /// Evenly spread over magnitudes, positive.
  double logUniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  /// The same with a random sign.
  double signedLog(double low, double high) {
    return (bits() & 1u) != 0 ? logUniform(low, high) : -logUniform(low, high);
  }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  glm::dvec3 inBox(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  /// Uniform on the unit sphere.
  glm::dvec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 6.283185307179586), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  glm::dquat rotation() {
    const glm::dvec3 axis = direction();
    return glm::normalize(glm::angleAxis(uniform(0, 6.283185307179586), axis));
  }

 private:
  std::uint64_t state_;
};

}  // namespace meniscus

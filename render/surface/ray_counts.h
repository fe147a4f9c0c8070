#pragma once
// What the shaders of a method count, ray by ray: in many copies, so that pixels seldom wait for each other.

#include <array>
#include <cstdint>
#include <string_view>

#include "render/gl/storage.h"
#include "render/render_stats.h"

namespace meniscus {

/// What all methods count: the first of Sums in shaders/include/sums.glsl.
struct RayCounts {
  std::uint32_t pixels, pieces, iterations, mostIterations, overflow, grazing, unfinished, hits;
};

/// All but the hits, which each method has its own word for.
void addCounts(SurfaceStats& stats, const RayCounts& counts);

/// Throws InputError if the driver ended loops (shaders/include/loops.glsl) of any pixels.
void checkLoops(std::string_view method, std::uint32_t pixels);

/// Reads a buffer that shaders have written to and sets it to zero.
void takeCopies(gl::Storage& buffer, void* copies, std::uint64_t bytes);

/// `Counts` is a copy's layout (std430): a RayCounts named `common`, then what only the method counts.
template <typename Counts>
class RayCountCopies {
 public:
  using Copies = std::array<Counts, 64>;  // kSums of shaders/include/sums.glsl

  /// With the context current.
  void prepare() {
    buffer_.reserve(sizeof(Copies));
    buffer_.zero();
  }
  void bindStorage(unsigned binding) const { buffer_.bindStorage(binding); }
  /// What was counted since the last call; what is common is added to `stats`.
  Copies take(SurfaceStats& stats) {
    Copies copies{};
    if (buffer_.bytes() == 0) return copies;
    takeCopies(buffer_, copies.data(), sizeof copies);
    for (const Counts& counts : copies) addCounts(stats, counts.common);
    return copies;
  }
  std::uint64_t bytes() const { return buffer_.bytes(); }

 private:
  gl::Storage buffer_;
};

}  // namespace meniscus

#pragma once
// Numbers of the balls of a field, or of other primitives, for shaders: software drivers read vectors from
// textures several times as fast as from buffers.

#include <cstddef>

#include "render/gl/objects.h"

namespace meniscus {

inline constexpr int kBallsPerRow = 1024;  // as in shaders/include/ball_texture.glsl

class BallTexture {
 public:
  /// So many texels of four floats for each ball; kBallsPerRow balls in a row.
  explicit BallTexture(int texelsPerBall) : texels_(texelsPerBall) {}
  /// Numbers of `count` balls one after the other. Throws InputError if the driver has no room for them.
  void upload(const void* numbers, std::size_t count);
  void bind(unsigned unit) const;
  std::uint64_t bytes() const { return texture_.object ? texture_.bytes() : 0; }

 private:
  int texels_;
  gl::Texture texture_;
};

}  // namespace meniscus

#include "render/surface/ball_texture.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "core/error.h"

namespace meniscus {

void BallTexture::upload(const void* numbers, std::size_t count) {
  const std::size_t most =
      static_cast<std::size_t>(gl::queryLimits().textureSize) * static_cast<std::size_t>(kBallsPerRow);
  if (count > most)
    throw InputError(fmt::format(
        "{} balls of a surface are in view, of which a texture of this driver holds {}; draw fewer atoms",
        count, most));
  const int balls = static_cast<int>(count), rows = (balls + kBallsPerRow - 1) / kBallsPerRow;
  if (texture_.desc.height < rows || !texture_.object) {
    texture_ = {};
    texture_ = gl::Texture::make({gl::TextureFormat::rgba32f, texels_ * kBallsPerRow, rows > 0 ? rows : 1});
  }
  const auto* row = static_cast<const std::byte*>(numbers);
  const auto upload = [&](int y, int height, int columns) {
    if (height > 0 && columns > 0)
      texture_.write(
          texels_ * columns, height,
          row + static_cast<std::size_t>(y) * kBallsPerRow * static_cast<std::size_t>(texels_) * 16, 0, y);
  };
  upload(0, balls / kBallsPerRow, kBallsPerRow);
  upload(balls / kBallsPerRow, 1, balls % kBallsPerRow);
}

void BallTexture::bind(unsigned unit) const {
  glBindTextureUnit(unit, texture_.object.name());
}

}  // namespace meniscus

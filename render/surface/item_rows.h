#pragma once
// Numbered items in textures whose rows hold so many of them, as shaders look them up.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/error.h"
#include "render/gl/objects.h"

namespace meniscus {

/// A texture of as many whole rows as `items` need; `items` grows to fill them. Throws InputError if the
/// driver's textures do not hold so many.
template <class T>
gl::Texture rowsOf(gl::TextureFormat format, std::vector<T>& items, int perRow, int texelsEach) {
  const std::size_t row = static_cast<std::size_t>(perRow);
  const std::size_t rows = std::max<std::size_t>((items.size() + row - 1) / row, 1);
  if (rows > static_cast<std::size_t>(gl::queryLimits().textureSize))
    throw InputError("the surface has more balls than the driver's textures hold; draw a part (--select)");
  items.resize(rows * row);
  gl::Texture texture = gl::Texture::make({format, perRow * texelsEach, static_cast<int>(rows)});
  texture.write(perRow * texelsEach, static_cast<int>(rows), items.data(), 0, 0);
  return texture;
}

}  // namespace meniscus

#pragma once
// The shader sources that are part of the binary.

#include <span>
#include <string_view>

namespace meniscus {

struct EmbeddedShader {
  std::string_view path;  ///< "quadrics/sphere.frag", relative to shaders/
  std::string_view text;
};

std::span<const EmbeddedShader> embeddedShaders();

}  // namespace meniscus

#pragma once
// Shows pictures of main memory in a window: what OSMesa draws, which no window shows by itself.

#include <cstddef>
#include <memory>
#include <span>

#include "core/image.h"

struct GLFWwindow;

namespace meniscus {

class Canvas {
 public:
  virtual ~Canvas() = default;
  /// RGBA, 8 bits, rows from the bottom; what is larger than the window is cut off.
  virtual void show(ImageSize size, std::span<const std::byte> pixels) = 0;
};

/// Of a window that lives longer. Throws GraphicsError, the reason alone: it is no window of X11, its colours
/// are no mixtures of red, green and blue, or this was built without X11.
std::unique_ptr<Canvas> makeCanvas(GLFWwindow* window);

}  // namespace meniscus

// Where there is no X11 to build with.

#include "app/view/canvas.h"
#include "core/error.h"

namespace meniscus {

std::unique_ptr<Canvas> makeCanvas(GLFWwindow*) {
  throw GraphicsError("this was built without X11, by which a window shows it (Debian: libx11-dev)");
}

}  // namespace meniscus

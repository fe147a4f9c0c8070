#include "tests/view/display_resources.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>

namespace meniscus::test {

bool setDisplayResources(const std::string& display, const std::string& resources) {
  Display* const connection = XOpenDisplay(display.c_str());
  if (connection == nullptr) return false;
  XChangeProperty(connection, DefaultRootWindow(connection), XA_RESOURCE_MANAGER, XA_STRING, 8,
                  PropModeReplace, reinterpret_cast<const unsigned char*>(resources.data()),
                  static_cast<int>(resources.size()));
  XCloseDisplay(connection);
  return true;
}

}  // namespace meniscus::test

#include "tests/view/window_pixels.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <cstddef>

namespace meniscus::test {

WindowPixels WindowPixels::rightOf(int left) const {
  WindowPixels part{width - left, height, {}};
  for (int y = 0; y < height; ++y)
    part.rgb.insert(part.rgb.end(), rgb.begin() + std::ptrdiff_t{y} * width + left,
                    rgb.begin() + std::ptrdiff_t{y + 1} * width);
  return part;
}

WindowPixels pixelsOf(const std::string& display, unsigned long window) {
  WindowPixels pixels;
  Display* const connection = XOpenDisplay(display.c_str());
  if (connection == nullptr) return pixels;
  XWindowAttributes attributes;
  if (XGetWindowAttributes(connection, window, &attributes) != 0 && attributes.map_state == IsViewable) {
    XImage* const image = XGetImage(connection, window, 0, 0, static_cast<unsigned>(attributes.width),
                                    static_cast<unsigned>(attributes.height), AllPlanes, ZPixmap);
    if (image != nullptr && image->red_mask == 0xFF0000 && image->green_mask == 0xFF00 &&
        image->blue_mask == 0xFF) {
      pixels.width = image->width;
      pixels.height = image->height;
      for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x)
          pixels.rgb.push_back(static_cast<std::uint32_t>(XGetPixel(image, x, y) & 0xFFFFFF));
    }
    if (image != nullptr) XDestroyImage(image);
  }
  XCloseDisplay(connection);
  return pixels;
}

}  // namespace meniscus::test

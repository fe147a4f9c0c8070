// X11's own way (Xlib, chapter 8.7: XPutImage).

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <dlfcn.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "app/view/canvas.h"
#include "core/error.h"

namespace meniscus {
namespace {

/// The bits of a pixel that each value of a channel stands for.
using ChannelBits = std::array<std::uint32_t, 256>;

ChannelBits bitsFor(unsigned long mask) {
  ChannelBits bits;
  const double most = std::ldexp(1.0, std::popcount(mask)) - 1;
  for (std::size_t value = 0; value < bits.size(); ++value)
    bits[value] = static_cast<std::uint32_t>(std::lround(static_cast<double>(value) / 255 * most)
                                             << std::countr_zero(mask));
  return bits;
}

class X11Canvas : public Canvas {
 public:
  X11Canvas(Display* display, ::Window window) : display_(display), window_(window) {
    XGetWindowAttributes(display_, window_, &attributes_);
    const Visual& visual = *attributes_.visual;
    if (visual.c_class != TrueColor || visual.red_mask == 0 || visual.green_mask == 0 ||
        visual.blue_mask == 0)
      throw GraphicsError(
          "the screen has colours from a palette; only mixtures of red, green and blue serve");
    red_ = bitsFor(visual.red_mask);
    green_ = bitsFor(visual.green_mask);
    blue_ = bitsFor(visual.blue_mask);
    // A window with an alpha channel is opaque.
    for (std::uint32_t& bits : red_)
      bits |= static_cast<std::uint32_t>(~(visual.red_mask | visual.green_mask | visual.blue_mask));
    context_ = XCreateGC(display_, window_, 0, nullptr);
  }
  X11Canvas(const X11Canvas&) = delete;
  X11Canvas& operator=(const X11Canvas&) = delete;
  ~X11Canvas() override {
    forgetImage();
    XFreeGC(display_, context_);
  }

  void show(ImageSize size, std::span<const std::byte> pixels) override {
    if (size.width < 1 || size.height < 1) return;
    if (!image_ || image_->width != size.width || image_->height != size.height) makeImage(size);
    const std::size_t rowBytes = std::size_t{4} * static_cast<std::size_t>(size.width);
    for (int y = 0; y < size.height; ++y)
      fillRow(y, pixels.subspan(static_cast<std::size_t>(size.height - 1 - y) * rowBytes, rowBytes));
    XPutImage(display_, window_, context_, image_, 0, 0, 0, 0, static_cast<unsigned>(size.width),
              static_cast<unsigned>(size.height));
    XFlush(display_);
  }

 private:
  void makeImage(ImageSize size) {
    forgetImage();
    constexpr int kRowAlignment = 32;
    image_ = XCreateImage(display_, attributes_.visual, static_cast<unsigned>(attributes_.depth), ZPixmap, 0,
                          nullptr, static_cast<unsigned>(size.width), static_cast<unsigned>(size.height),
                          kRowAlignment, 0);
    if (!image_) throw GraphicsError("X11 makes no image of the window's size");
    // Ours; XPutImage exchanges them where the server's is another.
    image_->byte_order = std::endian::native == std::endian::little ? LSBFirst : MSBFirst;
    XInitImage(image_);
    data_.resize(static_cast<std::size_t>(image_->bytes_per_line) * static_cast<std::size_t>(size.height));
    image_->data = data_.data();
  }

  void forgetImage() {
    if (!image_) return;
    image_->data = nullptr;  // data_'s
    XDestroyImage(image_);
    image_ = nullptr;
  }

  void fillRow(int y, std::span<const std::byte> rgba) {
    char* const row = data_.data() + static_cast<std::ptrdiff_t>(y) * image_->bytes_per_line;
    for (int x = 0; x < image_->width; ++x) {
      const std::byte* const from = rgba.data() + std::ptrdiff_t{4} * x;
      const std::uint32_t pixel = red_[static_cast<std::size_t>(from[0])] |
                                  green_[static_cast<std::size_t>(from[1])] |
                                  blue_[static_cast<std::size_t>(from[2])];
      if (image_->bits_per_pixel == 32) {
        std::memcpy(row + std::ptrdiff_t{4} * x, &pixel, sizeof(pixel));
      } else {
        XPutPixel(image_, x, y, pixel);
      }
    }
  }

  Display* display_;
  ::Window window_;
  XWindowAttributes attributes_{};
  GC context_ = nullptr;
  XImage* image_ = nullptr;
  std::vector<char> data_;
  ChannelBits red_{}, green_{}, blue_{};
};

// A GLFW that was built for Wayland has no such functions: it is asked for them at run time.
template <typename Function>
Function* ofGlfw(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

std::unique_ptr<Canvas> makeCanvas(GLFWwindow* window) {
  const auto displayOf = ofGlfw<Display*()>("glfwGetX11Display");
  const auto windowOf = ofGlfw<::Window(GLFWwindow*)>("glfwGetX11Window");
  Display* const display = displayOf && windowOf ? displayOf() : nullptr;
  if (!display) throw GraphicsError("it can be shown in windows of X11 only, and this is none");
  return std::make_unique<X11Canvas>(display, windowOf(window));
}

}  // namespace meniscus

#pragma once
// Pictures on their way from the renderer to a file: rows from the top, band by band, so that a poster
// never has to fit into memory at once.

#include <cstddef>
#include <cstdint>
#include <span>

namespace meniscus {

struct ImageSize {
  int width = 1024;
  int height = 768;
  bool operator==(const ImageSize&) const = default;
};

enum class PixelFormat : std::uint8_t {
  rgba8,     ///< sRGB-encoded, straight alpha, 4 bytes a pixel
  rgba16,    ///< the same with 2 bytes a channel, host byte order
  rgbaFloat  ///< linear light, premultiplied alpha, 4 floats a pixel
};

constexpr std::size_t bytesPerPixel(PixelFormat format) {
  return format == PixelFormat::rgba8 ? 4 : format == PixelFormat::rgba16 ? 8 : 16;
}

/// Receives a picture's rows in order from the top; every call holds one or more whole rows, tightly packed.
class RowSink {
 public:
  virtual ~RowSink() = default;
  virtual void writeRows(std::span<const std::byte> rows) = 0;
};

}  // namespace meniscus

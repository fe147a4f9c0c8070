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

/// What a picture holds, pixel by pixel. The colour is the mean of a pixel's samples; all else is data of the
/// ray through the pixel's centre.
struct Layers {
  bool color = true;
  bool albedo = false;  ///< 3 floats: the surface's own colour, linear light; a miss is 0
  bool normal = false;  ///< 3 floats: unit, view space, towards the viewer; a miss is 0
  bool depth = false;   ///< 1 float: along the optical axis, in front of the eye (perspective) or behind the
                        ///< near plane (orthographic) [Å]; a miss is +infinity
  bool distance = false;  ///< 1 float: along the unit ray [Å]; a miss is +infinity
  bool id = false;        ///< std::uint32_t: 1-based atom; a miss is 0
  bool operator==(const Layers&) const = default;
  constexpr bool data() const { return albedo || normal || depth || distance || id; }
};

/// How a pixel lies in memory: the colour, then the other layers in the order of Layers, without gaps.
struct PixelLayout {
  PixelFormat format = PixelFormat::rgba8;  ///< of the colour; rgbaFloat if there are other layers
  Layers layers;
  PixelLayout() = default;
  PixelLayout(PixelFormat f, const Layers& l = {}) : format(f), layers(l) {}
};

inline std::size_t bytesPerPixel(const PixelLayout& layout) {
  const Layers& l = layout.layers;
  return (l.color ? bytesPerPixel(layout.format) : 0) +
         4 * ((l.albedo ? 3u : 0u) + (l.normal ? 3u : 0u) + (l.depth ? 1u : 0u) + (l.distance ? 1u : 0u) +
              (l.id ? 1u : 0u));
}

/// Receives a picture's rows in order from the top; every call holds one or more whole rows, tightly packed.
class RowSink {
 public:
  virtual ~RowSink() = default;
  virtual void writeRows(std::span<const std::byte> rows) = 0;
};

}  // namespace meniscus

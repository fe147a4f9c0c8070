#pragma once
// PNG and OpenEXR files, written row by row. libpng and OpenEXR are used directly: loading OpenImageIO costs
// 0.22 CPU seconds per process (measured on Debian 12), more than the whole budget of a small picture; it
// stays the judge in the tests.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace meniscus {

enum class ImageType : std::uint8_t { png, exr };

/// By the extension, in any letter case; PNG for a device or pipe without one (/dev/stdout). Throws
/// UsageError naming what is supported.
ImageType imageTypeOf(const std::filesystem::path& path);

struct ImageFileOptions {
  ImageSize size;
  PixelFormat format = PixelFormat::rgba8;  ///< png: rgba8 or rgba16; exr: rgbaFloat
  bool alpha = false;  ///< false: the alpha channel is dropped (the background is opaque)
  Layers layers;       ///< png: the colour only
  /// exr: ids are whole numbers of 32 bits instead of floats, which hold them exactly up to 2^24 only.
  bool wideIds = false;
  double dpi = 0;                                             ///< PNG pHYs; 0 = not written
  std::vector<std::pair<std::string, std::string>> metadata;  ///< PNG iTXt / EXR string attributes
};

/// A picture file under construction. It is written under a temporary name beside `path` and renamed by
/// finish(); if it is destroyed before, nothing is left behind and an older file at `path` stays whole.
/// Errors of the file system are InputError naming the path and the remedy; the constructor fails early when
/// the folder is missing or not writable.
class ImageFile : public RowSink {
 public:
  /// Called with the path first so that an unwritable output is reported before any rendering.
  static std::unique_ptr<ImageFile> create(const std::filesystem::path& path,
                                           const ImageFileOptions& options);

  /// All rows must have been written.
  virtual void finish() = 0;
};

}  // namespace meniscus

#include "io/image_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/text.h"
#include "io/image_files.h"
#include "io/output_file.h"

namespace meniscus {

ImageType imageTypeOf(const std::filesystem::path& path) {
  const std::string extension = lowerCase(path.extension().string());
  if (extension == ".png") return ImageType::png;
  if (extension == ".exr") return ImageType::exr;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (extension.empty() && (is_character_file(status) || is_fifo(status))) return ImageType::png;
  throw UsageError(fmt::format("'{}': pictures are written as .png or .exr; let the name end in one of them",
                               path.string()));
}

std::unique_ptr<ImageFile> ImageFile::create(const std::filesystem::path& path,
                                             const ImageFileOptions& options) {
  MENISCUS_CHECK(options.size.width > 0 && options.size.height > 0);
  if (imageTypeOf(path) == ImageType::exr) return createExrFile(path, options);
  MENISCUS_CHECK(options.layers == Layers{});
  return createPngFile(path, options);
}

}  // namespace meniscus

#pragma once
// The file types behind ImageFile::create, one .cpp each.

#include <memory>

#include "io/image_writer.h"

namespace meniscus {

std::unique_ptr<ImageFile> createPngFile(const std::filesystem::path& path, const ImageFileOptions& options);
std::unique_ptr<ImageFile> createExrFile(const std::filesystem::path& path, const ImageFileOptions& options);

}  // namespace meniscus

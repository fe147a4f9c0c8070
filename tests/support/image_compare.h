#pragma once
// Pictures judged by OpenImageIO. Three numbers decide, as in its own test suite.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace meniscus::test {

struct Tolerance {
  double threshold = 0.004;  ///< a pixel fails if a channel (0..1) differs by more
  double percent = 0.05;     ///< an image fails if more than this share [%] of its pixels fail
  double hard = 0.05;        ///< or if any channel differs by more than this
};

/// Compares an rgba8 picture, rows from the top, with a stored PNG. On failure the picture and the amplified
/// difference are kept beside the test as `<name>-actual.png` and `<name>-difference.png`, and the test
/// fails, naming them. With the environment variable MENISCUS_UPDATE_GOLDEN set, the stored image is replaced
/// instead.
void expectMatchesStored(const std::vector<std::byte>& picture, ImageSize size,
                         const std::filesystem::path& stored, const Tolerance& tolerance = {});

/// Compares two rgba8 pictures of one size; keeps files as above under `name`.
void expectSimilar(const std::vector<std::byte>& picture, const std::vector<std::byte>& other, ImageSize size,
                   const std::string& name, const Tolerance& tolerance = {});

}  // namespace meniscus::test

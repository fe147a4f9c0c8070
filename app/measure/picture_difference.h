#pragma once
// How visible an error is: two pictures compared by OpenImageIO's measures. (FLIP, the alternative, is in no
// distribution's packages.)

#include <filesystem>
#include <optional>

namespace meniscus::measure {

struct PictureDifference {
  double rms = 0;      ///< of the channels, 0 to 1
  double psnr = 0;     ///< peak signal to noise [dB]; infinite for equal pictures
  double largest = 0;  ///< of one channel of a pixel
};

/// Compares two picture files of one size by OpenImageIO's program `idiff`, a process of its own: its library
/// would cost every run of this program more than most of them take. Empty if it is not installed. Throws
/// InputError if it cannot read them or answers something else.
std::optional<PictureDifference> comparePictures(const std::filesystem::path& a,
                                                 const std::filesystem::path& b);

}  // namespace meniscus::measure

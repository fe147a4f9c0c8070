#pragma once
// Pictures of what is all around: OpenEXR through its own library, PNG and JPEG through stb, and Radiance's
// .hdr (G. Ward, Real Pixels, Graphics Gems II, 1991).

#include <filesystem>
#include <memory>

#include "core/environment_map.h"

namespace meniscus {

/// Whether a name ends as those of the files do that readEnvironment() reads; in any letter case.
bool isEnvironmentName(const std::filesystem::path& path);

/// Reads an equirectangular picture, twice as wide as high, as linear light: what is in .exr and .hdr files
/// as it is (chromaticities are taken for Rec. 709), PNG and JPEG from sRGB. Alpha is ignored, negative light
/// is none. What it is, the content says. Throws InputError if there is no such picture, if it is damaged,
/// larger than 8192 x 4096, or has light that is not finite.
std::shared_ptr<const EnvironmentMap> readEnvironment(const std::filesystem::path& path);

}  // namespace meniscus

#pragma once
// Text as pictures, by FreeType.

#include <filesystem>
#include <vector>

#include "core/label_sprite.h"

namespace meniscus {

/// The labels' texts (UTF-8; a line feed begins a new line) with letters `pixels` high, ascenders and
/// descenders together. `font` empty = DejaVu Sans, where Debian and others keep it. Throws InputError if
/// there is no usable font.
std::vector<LabelSprite> drawLabels(const std::vector<Label>& labels, double pixels,
                                    const std::filesystem::path& font);

}  // namespace meniscus

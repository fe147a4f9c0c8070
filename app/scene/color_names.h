#pragma once
// Colours as MolViewSpec writes them.

#include <optional>
#include <string_view>

#include "core/scene.h"

namespace meniscus {

/// A colour by its X11/CSS name, in any letter case, or as #RGB or #RRGGBB; nothing if it is neither.
std::optional<Rgb> colorByName(std::string_view text);

}  // namespace meniscus

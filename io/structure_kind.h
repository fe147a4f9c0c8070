#pragma once
// What kind of structure file a text is, by its content.

#include <cstdint>
#include <string_view>

namespace meniscus {

enum class StructureKind : std::uint8_t { pdb, mmcif };

/// Throws InputError, without the file's name, for what is neither, saying what it is if it is known.
/// `extension` (".gro", lower case, ".gz" taken off) only helps to name it.
StructureKind detectKind(std::string_view text, std::string_view extension);

}  // namespace meniscus

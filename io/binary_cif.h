#pragma once
// BinaryCIF: D. Sehnal et al., BinaryCIF and CIFTools, PLoS Comput. Biol. 16, e1008247 (2020),
// doi 10.1371/journal.pcbi.1008247; version 0.3.

#include <string>
#include <string_view>

namespace meniscus {

/// Whether bytes look like BinaryCIF: a MessagePack map with data blocks.
bool isBinaryCif(std::string_view bytes);

/// The same data as mmCIF text. Throws InputError, without the file's name, where the bytes are damaged.
std::string textFromBinaryCif(std::string_view bytes);

}  // namespace meniscus

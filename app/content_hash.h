#pragma once
// Names for contents: equal bytes, equal names (XXH3, 128 bits; not against forgery).

#include <string>
#include <string_view>

namespace meniscus {

/// 32 hexadecimal digits.
std::string contentHash(std::string_view bytes);

}  // namespace meniscus

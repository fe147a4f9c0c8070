#pragma once

#include <string>

namespace meniscus::test {

/// What xrdb would load into a display, such as "Xft.dpi: 192\n"; for windows that are opened afterwards.
/// false: there is no such display.
bool setDisplayResources(const std::string& display, const std::string& resources);

}  // namespace meniscus::test

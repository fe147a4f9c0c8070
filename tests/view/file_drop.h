#pragma once
// Files dragged from a file manager and dropped into a window, as X11's drag-and-drop protocol has it (XDND
// 5, https://freedesktop.org/wiki/Specifications/XDND).

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::test {

/// Drops files into the middle of a window of another program. What went wrong; empty if the program took
/// them.
std::string dropFiles(const std::string& display, unsigned long window,
                      const std::vector<std::filesystem::path>& files);

}  // namespace meniscus::test

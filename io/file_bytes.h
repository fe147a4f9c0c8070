#pragma once
// A file's bytes as they are meant: decompressed if they are gzip, whatever the file is called.

#include <filesystem>
#include <string>

namespace meniscus {

/// Reads a whole file, inflating gzip by content. Throws InputError if the file is missing, a folder, empty,
/// unreadable, truncated or damaged gzip, compressed in another way, or larger than 4 GiB (decompressed).
std::string readText(const std::filesystem::path& path);

/// The two steps of it: the bytes as they are in the file, and what they mean; `path` is only named in
/// errors.
std::string readBytes(const std::filesystem::path& path);
std::string textOf(std::string bytes, const std::filesystem::path& path);

}  // namespace meniscus

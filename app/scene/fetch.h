#pragma once
// Files from the web, kept in a folder so that each is fetched once.

#include <filesystem>
#include <string>

namespace meniscus {

/// $XDG_CACHE_HOME/meniscus or ~/.cache/meniscus; empty if neither is known, then nothing is kept.
std::filesystem::path defaultCacheFolder();

/// The bytes at an http: or https: address, from `cache` if they are there, else through libcurl and into
/// it. A copy in the cache is never fetched again. Throws InputError with the reason and the remedy; with
/// `offline`, if the cache has no copy.
std::string fetch(const std::string& url, const std::filesystem::path& cache, bool offline);

}  // namespace meniscus

#include "app/scene/fetch.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <system_error>

#include "app/commands.h"
#include "app/content_hash.h"
#include "core/error.h"
#include "io/file_bytes.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

constexpr std::size_t kMostFetchedBytes = std::size_t{4} << 30;
constexpr long kConnectSeconds = 30, kStalledSeconds = 60, kMostRedirects = 10;

std::size_t collect(char* data, std::size_t size, std::size_t count, void* target) {
  auto& bytes = *static_cast<std::string*>(target);
  if (bytes.size() + size * count > kMostFetchedBytes) return 0;  // curl then stops with a write error
  bytes.append(data, size * count);
  return size * count;
}

std::string download(const std::string& url) {
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  const std::unique_ptr<CURL, void (*)(CURL*)> curl(curl_easy_init(), curl_easy_cleanup);
  if (ready != CURLE_OK || !curl) throw InputError("libcurl does not start");
  std::string bytes;
  char reason[CURL_ERROR_SIZE] = "";
  CURL* c = curl.get();
  curl_easy_setopt(c, CURLOPT_URL, url.c_str());
  curl_easy_setopt(c, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(c, CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(c, CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(c, CURLOPT_MAXREDIRS, kMostRedirects);
  curl_easy_setopt(c, CURLOPT_FAILONERROR, 1L);
  curl_easy_setopt(c, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(c, CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
  curl_easy_setopt(c, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(c, CURLOPT_LOW_SPEED_TIME, kStalledSeconds);
  curl_easy_setopt(c, CURLOPT_USERAGENT, (std::string("meniscus/") + version()).c_str());
  curl_easy_setopt(c, CURLOPT_ERRORBUFFER, reason);
  curl_easy_setopt(c, CURLOPT_WRITEFUNCTION, collect);
  curl_easy_setopt(c, CURLOPT_WRITEDATA, &bytes);
  const CURLcode result = curl_easy_perform(c);
  if (result == CURLE_WRITE_ERROR) throw InputError(fmt::format("'{}' is larger than 4 GiB", url));
  if (result != CURLE_OK)
    throw InputError(fmt::format("'{}' cannot be fetched ({}): check the address and the connection", url,
                                 reason[0] ? reason : curl_easy_strerror(result)));
  return bytes;
}

}  // namespace

std::filesystem::path defaultCacheFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && cache[0] == '/')
    return std::filesystem::path(cache) / "meniscus";
  if (const char* home = std::getenv("HOME"); home && home[0] == '/')
    return std::filesystem::path(home) / ".cache" / "meniscus";
  return {};
}

std::string fetch(const std::string& url, const std::filesystem::path& cache, bool offline) {
  const std::filesystem::path copy = cache.empty() ? cache : cache / contentHash(url);
  std::error_code none;
  if (!copy.empty() && std::filesystem::is_regular_file(copy, none)) return readBytes(copy);
  if (offline)
    throw InputError(
        fmt::format("'{}' is not in the cache; leave out --offline once, or name a local file", url));
  std::string bytes = download(url);
  if (!copy.empty()) {
    std::filesystem::create_directories(cache, none);
    // A cache that cannot be written costs time, not the picture.
    try {
      writeTextFile(copy, bytes);
    } catch (const InputError&) {
    }
  }
  return bytes;
}

}  // namespace meniscus

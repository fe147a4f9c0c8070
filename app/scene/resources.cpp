#include "app/scene/resources.h"

#include <fmt/format.h>

#include "app/scene/archive.h"
#include "app/scene/fetch.h"
#include "core/error.h"
#include "io/file_bytes.h"

namespace meniscus {
namespace {

/// The scheme of an address in small letters ("https"); empty for a path.
std::string schemeOf(const std::string& url) {
  const std::size_t colon = url.find(':');
  if (colon == std::string::npos || colon < 2) return {};  // one letter is a drive
  std::string scheme = url.substr(0, colon);
  for (char& c : scheme) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return {};
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return scheme;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// file:/path, file:///path, file://localhost/path (RFC 8089).
std::filesystem::path pathOfFileUrl(const JsonPlace& url) {
  std::string rest = url.string().substr(url.string().find(':') + 1);
  if (rest.starts_with("//")) {
    rest.erase(0, 2);
    if (rest.starts_with("localhost/")) rest.erase(0, 9);
    if (!rest.starts_with('/')) url.fail("names a file on another machine; write file:///path");
  }
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool escape = rest[i] == '%' && i + 2 < rest.size() && hexDigit(rest[i + 1]) >= 0;
    if (escape && hexDigit(rest[i + 2]) >= 0) {
      path += static_cast<char>(16 * hexDigit(rest[i + 1]) + hexDigit(rest[i + 2]));
      i += 2;
    } else {
      path += rest[i];
    }
  }
  if (path.empty() || path.find('\0') != std::string::npos) url.fail("names no file");
  return path;
}

}  // namespace

SceneResources::SceneResources(std::filesystem::path scene, const ResourceOptions& options)
    : scene_(std::move(scene)), options_(options) {
  std::string bytes = readBytes(scene_);
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06")) {
    archive_ = std::make_unique<SceneArchive>(std::move(bytes), scene_.string());
    sceneText_ = archive_->read("index.mvsj");
  } else {
    sceneText_ = textOf(std::move(bytes), scene_);
  }
}

SceneResources::~SceneResources() = default;

const std::string& SceneResources::bytes(const JsonPlace& url) {
  const auto known = bytes_.find(url.string());
  if (known != bytes_.end()) return known->second;
  return bytes_.emplace(url.string(), read(url)).first->second;
}

std::string SceneResources::read(const JsonPlace& url) const {
  const std::string& address = url.string();
  if (address.empty() || address.find('\0') != std::string::npos) url.fail("is no address");
  const std::string scheme = schemeOf(address);
  try {
    if (scheme == "http" || scheme == "https")
      return fetch(address, options_.cache.empty() ? defaultCacheFolder() : options_.cache, options_.offline);
    if (scheme == "file") return readBytes(pathOfFileUrl(url));
    if (!scheme.empty())
      url.fail(fmt::format("'{}': {}: is not supported; there are paths, file:, http: and https:", address,
                           scheme));
    if (archive_) return archive_->read(address);
    return readBytes(scene_.parent_path() / address);
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with(url.path())) throw;
    url.fail(error.what());
  }
}

}  // namespace meniscus

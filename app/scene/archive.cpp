#include "app/scene/archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr zip_uint64_t kMostBytes = zip_uint64_t{4} << 30;
constexpr zip_uint64_t kBombRatio = 200;  // as for gzipped structures (io/file_bytes.cpp)
constexpr zip_uint64_t kBombFloor = zip_uint64_t{64} << 20;

/// The path with "." and empty parts taken out and ".." resolved; nothing if it leaves the archive.
std::optional<std::string> normalized(std::string_view path) {
  if (path.starts_with('/') || path.starts_with('\\') || path.substr(1, 1) == ":") return std::nullopt;
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    const std::size_t end = path.find_first_of("/\\");
    const std::string_view part = path.substr(0, end);
    path = end == std::string_view::npos ? std::string_view() : path.substr(end + 1);
    if (part.empty() || part == ".") continue;
    if (part != "..") {
      parts.push_back(part);
    } else if (parts.empty()) {
      return std::nullopt;
    } else {
      parts.pop_back();
    }
  }
  return fmt::format("{}", fmt::join(parts, "/"));
}

}  // namespace

struct SceneArchive::Impl {
  std::string bytes, name;
  zip_t* archive = nullptr;

  Impl(std::string b, std::string n) : bytes(std::move(b)), name(std::move(n)) {}
  ~Impl() {
    if (archive) zip_discard(archive);
  }
  [[noreturn]] void fail(std::string_view what) const { throw InputError(fmt::format("{}: {}", name, what)); }
};

SceneArchive::SceneArchive(std::string bytes, std::string name)
    : impl_(std::make_unique<Impl>(std::move(bytes), std::move(name))) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(impl_->bytes.data(), impl_->bytes.size(), 0, &error);
  if (source) impl_->archive = zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error);
  if (!impl_->archive) {
    const std::string what = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (source) zip_source_free(source);
    impl_->fail(fmt::format("is no sound zip archive ({}): make it again", what));
  }
  zip_error_fini(&error);
  const zip_int64_t entries = zip_get_num_entries(impl_->archive, 0);
  for (zip_int64_t i = 0; i < entries; ++i) {
    const char* entry = zip_get_name(impl_->archive, static_cast<zip_uint64_t>(i), 0);
    const std::optional<std::string> path = entry ? normalized(entry) : std::nullopt;
    const bool climbs = entry && std::string_view(entry).find("..") != std::string_view::npos &&
                        path != std::string_view(entry);
    if (!path || climbs)
      impl_->fail(fmt::format("entry '{}' points outside of the archive: it is not to be trusted",
                              entry ? entry : "?"));
  }
}

SceneArchive::~SceneArchive() = default;

std::string SceneArchive::read(const std::string& entry) const {
  const std::optional<std::string> path = normalized(entry);
  if (!path) impl_->fail(fmt::format("'{}' points outside of the archive", entry));
  const zip_int64_t index = zip_name_locate(impl_->archive, path->c_str(), 0);
  if (index < 0) impl_->fail(fmt::format("holds no '{}'", *path));
  const auto which = static_cast<zip_uint64_t>(index);
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat_index(impl_->archive, which, 0, &status) != 0 || (status.valid & ZIP_STAT_SIZE) == 0)
    impl_->fail(fmt::format("'{}' cannot be read", *path));
  if (status.size > kMostBytes) impl_->fail(fmt::format("'{}' is larger than 4 GiB", *path));
  if (status.size > kBombFloor && status.size / kBombRatio > status.comp_size)
    impl_->fail(fmt::format("'{}' is more than {} times as large as in the archive, as no structure is",
                            *path, kBombRatio));
  zip_file_t* file = zip_fopen_index(impl_->archive, which, 0);
  if (!file) impl_->fail(fmt::format("'{}' cannot be read ({})", *path, zip_strerror(impl_->archive)));
  std::string bytes(static_cast<std::size_t>(status.size), '\0');
  std::size_t done = 0;
  zip_int64_t got = 1;
  while (done < bytes.size() && (got = zip_fread(file, bytes.data() + done, bytes.size() - done)) > 0)
    done += static_cast<std::size_t>(got);
  // Reading on to the end compares the checksum.
  char beyond = 0;
  const bool sound = done == bytes.size() && got >= 0 && zip_fread(file, &beyond, 1) == 0;
  zip_fclose(file);
  if (!sound) impl_->fail(fmt::format("'{}' is damaged: make the archive again", *path));
  return bytes;
}

}  // namespace meniscus

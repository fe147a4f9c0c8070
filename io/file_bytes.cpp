#include "io/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 30;
constexpr std::size_t kChunk = std::size_t{1} << 20;
// Structure files shrink by a factor of 3 to 15. Deflate's limit is 1032; only a bomb comes near.
constexpr std::size_t kBombRatio = 200;
constexpr std::size_t kBombFloor = std::size_t{64} << 20;

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) {
      fail(path, errno == ENOENT
                     ? "no such file: check the path"
                     : fmt::format("cannot be opened ({}): check its permissions", std::strerror(errno)));
    }
  }
  ~Descriptor() { ::close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

bool startsWith(std::string_view bytes, std::string_view prefix) {
  return bytes.substr(0, prefix.size()) == prefix;
}

/// Text has no NUL and hardly any other control characters.
bool looksBinary(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  std::size_t odd = 0;
  for (const char c : head) {
    const auto u = static_cast<unsigned char>(c);
    if (u == 0) return true;
    if (u < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\v') ++odd;
    if (u == 127) ++odd;
  }
  return odd * 50 > head.size();
}

class Inflater {
 public:
  Inflater() { ready_ = inflateInit2(&stream, 15 + 16) == Z_OK; }
  ~Inflater() {
    if (ready_) inflateEnd(&stream);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  bool ready() const { return ready_; }
  z_stream stream{};

 private:
  bool ready_ = false;
};

void checkExpansion(const std::filesystem::path& path, std::size_t packed, std::size_t size) {
  if (size > kMaxBytes) fail(path, "decompresses to more than 4 GiB: split it");
  if (size > kBombFloor && size / kBombRatio > packed) {
    fail(path,
         fmt::format(
             "decompresses to more than {} times its size, as no structure does: decompress it yourself "
             "if it can be trusted",
             kBombRatio));
  }
}

/// All members of a gzip file, one after the other.
std::string inflateAll(const std::filesystem::path& path, const std::string& packed) {
  Inflater inflater;
  if (!inflater.ready()) fail(path, "zlib does not start: not enough memory");
  z_stream& stream = inflater.stream;
  std::string text;
  text.resize(std::clamp(packed.size() * 5, std::size_t{4096}, kBombFloor));
  std::size_t in = 0;
  std::size_t out = 0;
  bool checked = false;
  for (;;) {
    if (out == text.size()) {
      checkExpansion(path, packed.size(), out * 2);
      text.resize(out * 2);
    }
    const std::size_t offered = std::min(packed.size() - in, kChunk);
    const std::size_t room = std::min(text.size() - out, kChunk);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));
    stream.avail_in = static_cast<uInt>(offered);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + out);
    stream.avail_out = static_cast<uInt>(room);
    const int result = inflate(&stream, Z_NO_FLUSH);
    in += offered - stream.avail_in;
    out += room - stream.avail_out;
    if (!checked && out > 4096) {
      checked = true;
      if (looksBinary(std::string_view(text).substr(0, out))) {
        fail(path, "holds compressed binary data: PDB or mmCIF, plain or gzipped, is read");
      }
    }
    if (result == Z_STREAM_END) {
      if (!startsWith(std::string_view(packed).substr(in), "\x1f\x8b")) break;
      if (inflateReset(&stream) != Z_OK) fail(path, "zlib does not restart");
    } else if (result == Z_BUF_ERROR || (result == Z_OK && in == packed.size() && stream.avail_out > 0)) {
      fail(path, "is truncated (its gzip stream ends early): fetch it again");
    } else if (result != Z_OK) {
      fail(path, fmt::format("is damaged (gzip: {}, after {} bytes): fetch it again",
                             stream.msg ? stream.msg : "bad data", in));
    }
  }
  text.resize(out);
  return text;
}

}  // namespace

std::string readBytes(const std::filesystem::path& path) {
  const Descriptor file(path);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) fail(path, "is a folder: name a structure file in it");
  std::string bytes;
  std::size_t size = 0;
  bytes.resize(S_ISREG(status.st_mode) ? static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)) + 1
                                       : kChunk);
  for (;;) {
    if (size == bytes.size()) bytes.resize(size * 2);
    const ssize_t got = ::read(file.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, fmt::format("cannot be read ({})", std::strerror(errno)));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size > kMaxBytes) fail(path, "is larger than 4 GiB: split it");
  }
  bytes.resize(size);
  return bytes;
}

std::string readText(const std::filesystem::path& path) {
  return textOf(readBytes(path), path);
}

std::string textOf(std::string bytes, const std::filesystem::path& path) {
  if (bytes.empty()) fail(path, "is empty: fetch it again");
  if (startsWith(bytes, "\x1f\x8b")) bytes = inflateAll(path, bytes);
  if (bytes.empty()) fail(path, "is empty once decompressed: fetch it again");
  if (startsWith(bytes, "BZh") ||
      startsWith(bytes,
                 "\xFD"
                 "7zXZ") ||
      startsWith(bytes, "\x28\xB5\x2F\xFD") || startsWith(bytes, "PK\x03\x04")) {
    fail(path, "is compressed as bzip2, xz, zstd or zip: decompress it, or use gzip");
  }
  return bytes;
}

}  // namespace meniscus

#pragma once
// A file that appears whole or not at all.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace meniscus {

/// Throws InputError with the remedy if `path` is a folder or write-protected, or if its folder is missing or
/// not writable. Writes nothing.
void requireWritable(const std::filesystem::path& path);

/// The InputError for a failed operation on an output: `path`, the reason (an errno value) and the remedy.
[[noreturn]] void throwWriteError(const std::filesystem::path& path, int errorNumber);

/// Opens a temporary name beside `path` for writing; commit() renames it over `path`. Destroyed before that,
/// it removes the temporary file. Throws InputError naming `path`, the reason, and the remedy. Writing to
/// something that is not a regular file (/dev/stdout, a named pipe) goes straight through.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::FILE* stream() const { return stream_; }
  const std::filesystem::path& path() const { return path_; }  ///< as given
  /// The name that is being written: the temporary one, or `path` itself where that is not a regular file.
  const std::filesystem::path& writtenPath() const { return temporary_; }
  void write(std::string_view bytes);
  void seek(std::uint64_t position);        ///< from the start of the file
  int failure() const { return failure_; }  ///< errno of the first operation that failed, 0 if none did
  /// Throws as write() does, also if an earlier operation failed and nobody noticed.
  void commit();

 private:
  void openTemporary();
  [[noreturn]] void fail(int errorNumber);

  std::filesystem::path path_;
  std::filesystem::path target_;  ///< path_ with symbolic links followed
  std::filesystem::path temporary_;
  std::FILE* stream_ = nullptr;
  int failure_ = 0;
  int slot_ = -1;  ///< in the list that removeTemporaryFiles() walks; negative: not in it
};

/// Writes a small text file (JSON, ...) in one go by the same rule.
void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Removes what unfinished OutputFiles of processes that were killed have left beside `path`; not what one
/// that runs, here or on another machine, is writing. What cannot be removed stays.
void removeAbandonedFiles(const std::filesystem::path& path);

/// Removes what unfinished OutputFiles of this process have written so far. Async-signal-safe: for the
/// handler of a signal that ends the process.
void removeTemporaryFiles() noexcept;

}  // namespace meniscus

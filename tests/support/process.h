#pragma once
// Running a program as a user would.

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace meniscus::test {

struct ProcessResult {
  int exitCode = -1;  ///< negative: ended by this signal
  bool timedOut = false;
  std::string out, err;
};

struct ProcessOptions {
  std::filesystem::path folder = ".";                            ///< working directory
  std::vector<std::pair<std::string, std::string>> environment;  ///< in addition to this process's own
  std::chrono::milliseconds timeout{120'000};                    ///< then it is killed
  int signal = 0;                                                ///< sent after `signalAfter` if not 0
  std::chrono::milliseconds signalAfter{0};
};

/// Runs argv[0] (a path) to its end with an empty standard input.
ProcessResult runProcess(const std::vector<std::string>& argv, const ProcessOptions& options = {});

/// A folder that exists as long as this.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  /// Names in it, hidden ones too, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string readFile(const std::filesystem::path& path);
void writeFile(const std::filesystem::path& path, const std::string& bytes);

}  // namespace meniscus::test

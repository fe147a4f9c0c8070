#include "app/measure/picture_difference.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"

namespace meniscus::measure {

namespace {

/// What a program says on stdout; empty if there is no such program.
std::optional<std::string> outputOf(std::vector<std::string> words) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw InputError(fmt::format("{}: cannot make a pipe", words[0]));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int failure = posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  close(ends[1]);
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 1; failure == 0 && count != 0;) {
    count = read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno != EINTR) break;
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(ends[0]);
  if (failure != 0) return std::nullopt;
  waitpid(process, nullptr, 0);
  return text;
}

// The number after `label`; NaN if there is none.
double numberAfter(const std::string& text, const std::string& label) {
  const std::size_t at = text.find(label);
  if (at == std::string::npos) return std::numeric_limits<double>::quiet_NaN();
  const char* start = text.c_str() + at + label.size();
  char* end = nullptr;
  const double value = std::strtod(start, &end);
  return end == start ? std::numeric_limits<double>::quiet_NaN() : value;
}

}  // namespace

std::optional<PictureDifference> comparePictures(const std::filesystem::path& a,
                                                 const std::filesystem::path& b) {
  const std::optional<std::string> said = outputOf({"idiff", "-v", a.string(), b.string()});
  if (!said) return std::nullopt;
  const PictureDifference difference{numberAfter(*said, "RMS error ="), numberAfter(*said, "Peak SNR ="),
                                     numberAfter(*said, "Max error  =")};
  if (!(difference.rms >= 0 && difference.psnr >= 0 && difference.largest >= 0))
    throw InputError(fmt::format("idiff cannot compare '{}' with '{}': {}", a.string(), b.string(),
                                 said->substr(0, said->find('\n'))));
  return difference;
}

}  // namespace meniscus::measure

#include "app/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/output_file.h"

extern char** environ;

namespace meniscus {
namespace {

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

/// What ffmpeg is told about the file it writes.
std::vector<std::string> encoding(const std::string& extension, ImageSize size) {
  // Codecs want even sides: a column or row more, like the last.
  const int column = size.width % 2, row = size.height % 2;
  const std::string even =
      column + row == 0
          ? "null"
          : fmt::format("format=gbrp,pad=iw+{0}:ih+{1},fillborders=right={0}:bottom={1}:mode=smear", column,
                        row);
  if (extension == ".gif")
    return {"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"};
  if (extension == ".webm")
    return {"-vf",  even, "-c:v",     "libvpx-vp9", "-crf", "24",
            "-b:v", "0",  "-pix_fmt", "yuv420p",    "-f",   "webm"};
  return {"-vf",      even,      "-c:v",      "libx264",    "-crf", "18",
          "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f",   "mp4"};
}

}  // namespace

bool isFilm(const std::filesystem::path& output) {
  const std::string extension = extensionOf(output);
  return extension == ".mp4" || extension == ".webm" || extension == ".gif";
}

void requireFilmNames(const RenderOptions& options, const OutputPattern& pattern) {
  const bool film = isFilm(options.output);
  if (options.turntable > 1 && !film && !pattern.namesFrame())
    throw UsageError(
        fmt::format("--turntable: '{}' is one name for {} pictures; put {{frame}} into it, or end it in .mp4",
                    options.output, options.turntable));
  if (pattern.namesFrame() && (film || options.turntable == 0))
    throw UsageError("--output: {frame} numbers the pictures of a --turntable; a film has one name");
  if (film && options.turntable == 0 && !options.structure.allModels && options.scenes.empty())
    throw UsageError(
        fmt::format("'{}': pictures are written as .png or .exr; a film needs --turntable or --model all",
                    options.output));
  if (film && (pattern.namesModel() || pattern.namesState()))
    throw UsageError(
        "--output: a film holds all models or states of its input, so {model} and {state} cannot name it");
}

void turn(Picture& picture, int frame, const RenderOptions& options, const OutputPattern& pattern) {
  const double angle = 2 * glm::pi<double>() * frame / options.turntable;
  Camera& camera = picture.scene.camera;
  camera.orientation = glm::normalize(glm::angleAxis(angle, glm::dvec3(0, 1, 0)) * camera.orientation);
  picture.place.frame = frame + 1;
  picture.output = pattern.nameFor(picture.input, picture.place);
}

struct FilmFile::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (child > 0) ::kill(child, SIGKILL);
    wait();
  }
  OutputFile file;
  int pipe = -1;
  pid_t child = 0;

  /// ffmpeg's exit code; 0 = well.
  int wait() {
    if (pipe >= 0) ::close(pipe);
    pipe = -1;
    int status = 0;
    while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    child = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  }
};

FilmFile::FilmFile(const std::filesystem::path& path, ImageSize size, double framesPerSecond)
    : impl_(std::make_unique<Impl>(path)) {
  std::vector<std::string> words{"ffmpeg",
                                 "-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pix_fmt",
                                 "rgba",
                                 "-s",
                                 fmt::format("{}x{}", size.width, size.height),
                                 "-r",
                                 fmt::format("{}", framesPerSecond),
                                 "-i",
                                 "-",
                                 "-map_metadata",
                                 "-1",
                                 "-fflags",
                                 "+bitexact"};
  for (const std::string& word : encoding(extensionOf(path), size)) words.push_back(word);
  words.push_back("file:" + impl_->file.writtenPath().string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw InputError(fmt::format("ffmpeg: no pipe ({})", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  // Ctrl-C is for this process, which ends the film.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error = ::posix_spawnp(&impl_->child, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  impl_->pipe = ends[1];
  if (error != 0) impl_->child = 0;
  if (error == ENOENT)
    throw UsageError(
        fmt::format("--output: '{}' needs ffmpeg, which is not installed; install it, or write pictures with "
                    "{{frame}}.png",
                    path.string()));
  if (error != 0) throw InputError(fmt::format("ffmpeg cannot be started ({})", std::strerror(error)));
  std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that gave up is met where it is waited for
}

FilmFile::~FilmFile() = default;

void FilmFile::writeRows(std::span<const std::byte> rows) {
  const std::byte* data = rows.data();
  std::size_t left = rows.size();
  while (left > 0) {
    const ssize_t done = ::write(impl_->pipe, data, left);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw InputError(fmt::format("ffmpeg has given up on '{}'", impl_->file.path().string()));
    data += done;
    left -= static_cast<std::size_t>(done);
  }
}

void FilmFile::finish() {
  if (impl_->wait() != 0)
    throw InputError(
        fmt::format("ffmpeg could not write '{}'; what it says stands above", impl_->file.path().string()));
  impl_->file.commit();
}

}  // namespace meniscus

#include "io/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace meniscus {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTemporaryName = ".meniscus-{}-{}.tmp";

// The names of the temporary files that exist, where a signal handler can read them: no allocation, no lock.
// A name is valid while its slot is `listed`. Files beyond the last slot are written all the same, only not
// listed.
struct TemporarySlot {
  enum State : int { empty, filling, listed };
  std::atomic<int> state{empty};
  std::array<char, 4096> name{};
};
std::array<TemporarySlot, 16> temporaries;
static_assert(std::atomic<int>::is_always_lock_free);

int listTemporary(const std::string& name) {
  for (std::size_t i = 0; i < temporaries.size(); ++i) {
    TemporarySlot& slot = temporaries[i];
    int expected = TemporarySlot::empty;
    if (name.size() >= slot.name.size() ||
        !slot.state.compare_exchange_strong(expected, TemporarySlot::filling))
      continue;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    slot.state.store(TemporarySlot::listed);
    return static_cast<int>(i);
  }
  return -1;
}

void unlistTemporary(int& slot) {
  if (slot >= 0) temporaries[static_cast<std::size_t>(slot)].state.store(TemporarySlot::empty);
  slot = -1;
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool allows(const fs::path& path, int mode) {
  return faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0;
}

bool goesStraightThrough(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// A link is written through to what it points to, as an editor would.
fs::path followLinks(const fs::path& path) {
  std::error_code error;
  fs::path target = fs::canonical(path, error);
  return error ? path : target;
}

std::string remedyFor(int errorNumber) {
  switch (errorNumber) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or write elsewhere";
    case EFBIG:
      return "write elsewhere, or raise the limit on file sizes (ulimit -f)";
    case EPIPE:
      return "the program that reads it has ended";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "write elsewhere";
  }
}

}  // namespace

void throwWriteError(const fs::path& path, int errorNumber) {
  throw InputError(fmt::format("cannot write '{}': {}; {}", path.string(),
                               std::generic_category().message(errorNumber), remedyFor(errorNumber)));
}

void requireWritable(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (path.empty() || !path.has_filename() || fs::is_directory(path, error))
    throw InputError(fmt::format("cannot write '{}': it is a folder; give the name of a file in it", name));

  const fs::path target = followLinks(path);
  const fs::path folder = folderOf(target);
  if (!fs::is_directory(folder, error)) {
    if (fs::exists(folder, error))
      throw InputError(
          fmt::format("cannot write '{}': '{}' is not a folder; write elsewhere", name, folder.string()));
    throw InputError(fmt::format("cannot write '{}': there is no folder '{}'; create it with mkdir -p", name,
                                 folder.string()));
  }
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0 && errno != ENOENT) throwWriteError(path, errno);
  if (fs::exists(target, error) && !allows(target, W_OK))
    throw InputError(
        fmt::format("cannot write '{}': it is write-protected; choose another name or chmod u+w it", name));
  if (!goesStraightThrough(path) && !allows(folder, W_OK | X_OK))
    throw InputError(
        fmt::format("cannot write '{}': no permission to write in '{}'; write to a folder of your own", name,
                    folder.string()));
}

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  requireWritable(path_);
  if (goesStraightThrough(path_)) {
    temporary_ = path_;
    stream_ = std::fopen(path_.c_str(), "wb");
    if (stream_ == nullptr) throwWriteError(path_, errno);
    return;
  }
  target_ = followLinks(path_);
  openTemporary();
}

void OutputFile::openTemporary() {
  struct stat old {};
  const bool replaces = stat(target_.c_str(), &old) == 0;
  static std::atomic<unsigned> counter{0};
  int descriptor = -1;
  do {
    temporary_ = folderOf(target_) / fmt::format(kTemporaryName, getpid(), counter++);
    slot_ = listTemporary(temporary_.string());
    descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) unlistTemporary(slot_);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) throwWriteError(path_, errno);
  static_cast<void>(flock(descriptor, LOCK_EX | LOCK_NB));  // says that it is being written
  // The new file keeps the permissions of the one it replaces; where that is not allowed, the usual ones are
  // right.
  if (replaces) static_cast<void>(fchmod(descriptor, old.st_mode & 0777));
  stream_ = fdopen(descriptor, "wb");
  MENISCUS_CHECK(stream_ != nullptr);
}

OutputFile::~OutputFile() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  if (temporary_ != path_) unlink(temporary_.c_str());
  unlistTemporary(slot_);
}

void OutputFile::fail(int errorNumber) {
  if (failure_ == 0) failure_ = errorNumber;
  throwWriteError(path_, failure_);
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail(errno);
}

void OutputFile::seek(std::uint64_t position) {
  if (fseeko(stream_, static_cast<off_t>(position), SEEK_SET) != 0) fail(errno);
}

void OutputFile::commit() {
  if (failure_ != 0) throwWriteError(path_, failure_);
  if (std::fflush(stream_) != 0) throwWriteError(path_, errno);
  std::FILE* stream = std::exchange(stream_, nullptr);
  const bool straight = temporary_ == path_;
  int failure = std::fclose(stream) == 0 ? 0 : errno;
  if (failure == 0 && !straight && std::rename(temporary_.c_str(), target_.c_str()) != 0) failure = errno;
  if (failure != 0 && !straight) unlink(temporary_.c_str());
  unlistTemporary(slot_);
  if (failure != 0) throwWriteError(path_, failure);
}

void writeTextFile(const fs::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void removeAbandonedFiles(const fs::path& path) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folderOf(path), error)) {
    long process = 0;
    unsigned number = 0;
    const std::string name = entry.path().filename().string();
    if (std::sscanf(name.c_str(), ".meniscus-%ld-%u.tmp", &process, &number) != 2 ||
        name != fmt::format(kTemporaryName, process, number) || !entry.is_regular_file(error) ||
        process < 1 || process > std::numeric_limits<pid_t>::max())
      continue;
    if (kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH) continue;
    const int descriptor = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) unlink(entry.path().c_str());
    close(descriptor);
  }
}

void removeTemporaryFiles() noexcept {
  for (TemporarySlot& slot : temporaries)
    if (slot.state.load() == TemporarySlot::listed) unlink(slot.name.data());
}

}  // namespace meniscus

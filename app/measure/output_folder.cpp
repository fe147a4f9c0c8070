#include "app/measure/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "io/output_file.h"

namespace meniscus::measure {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSidecar = "sidecar.json";

Json readSidecar(const fs::path& path) {
  std::ifstream file(path / kSidecar, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return Json::parse(text, nullptr, false);
}

[[noreturn]] void throwBusy(const fs::path& path) {
  throw InputError(fmt::format("another process measures into '{}'; wait for it, or give -o another folder",
                               path.string()));
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, const Sweep& sweep, bool shared) : path_(std::move(path)) {
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error))
    throw InputError(fmt::format("cannot write to '{}': it is a file; give -o a folder", path_.string()));
  const Json old = readSidecar(path_);
  if (old.is_object() && old.contains("sweep") && old["sweep"].dump() != Json::parse(sweep.text).dump())
    throw InputError(
        fmt::format("'{}' holds the points of another sweep; give -o another folder", path_.string()));
  for (const char* name : {"images", "layers", "truth"}) {
    if (std::string_view(name) == "layers" && !sweep.layers) continue;
    fs::create_directories(path_ / name, error);
    if (error)
      throw InputError(fmt::format("cannot make the folder '{}': {}; write elsewhere",
                                   (path_ / name).string(), error.message()));
  }
  requireWritable(path_ / kSidecar);
  if (!shared) lock();
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) close(lock_);
}

// Held until the process ends, however it does.
void OutputFolder::lock() {
  lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throwWriteError(path_, errno);
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) throwBusy(path_);
}

void OutputFolder::describe(const Sweep& sweep, const Machine& machine) const {
  Json json;
  json["version"] = machine.version;
  json["commit"] = machine.commit;
  json["backend"] = machine.backend;
  json["device"] = machine.device;
  json["driver"] = machine.driver;
  json["cpu"] = machine.cpu;
  json["threads"] = machine.threads;
  json["resolutions"] = Json::array();
  for (const ImageSize& size : sweep.sizes)
    json["resolutions"].push_back(fmt::format("{}x{}", size.width, size.height));
  json["seed"] = sweep.seed;
  json["repetitions"] = sweep.repetitions;
  json["name"] = sweep.name;
  json["sweep"] = Json::parse(sweep.text);
  const Json old = readSidecar(path_);
  if (old.is_object()) {
    for (const char* key : {"version", "commit", "backend", "device", "driver", "cpu"})
      if (old.contains(key) && old[key] != json[key])
        throw InputError(fmt::format("'{}' was measured with another {} ({}); give -o another folder",
                                     path_.string(), key, old[key].dump()));
  }
  writeTextFile(path_ / kSidecar, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace meniscus::measure

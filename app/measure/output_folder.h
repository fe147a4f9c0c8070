#pragma once
// The folder of a measurement: what belongs to which sweep, machine and program, so that a run that was
// interrupted goes on and no other is mixed into it.

#include <filesystem>
#include <string>

#include "app/measure/sweep.h"

namespace meniscus::measure {

/// Of the machine and the program, for the sidecar.
struct Machine {
  std::string version, commit, backend, device, driver, cpu;
  int threads = 0;
};

class OutputFolder {
 public:
  /// Makes the folder if it is not there. Throws InputError if it cannot be written, holds the points of
  /// another sweep or, unless it is to be shared, if another process measures into it.
  OutputFolder(std::filesystem::path path, const Sweep& sweep, bool shared = false);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Writes sidecar.json. Throws InputError if what is there was measured by another machine or program.
  void describe(const Sweep& sweep, const Machine& machine) const;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  void lock();

  std::filesystem::path path_;
  int lock_ = -1;  // a descriptor
};

/// "GenuineIntel ...": the processor's name.
std::string processorName();

/// The Git commit that the program was built from; "unknown" outside of a clone.
const char* commit();

}  // namespace meniscus::measure

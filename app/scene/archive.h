#pragma once
// A zip archive in memory (.mvsx), read through libzip. Entries are only ever read into memory: no name in
// an archive becomes a path on this machine.

#include <memory>
#include <string>

namespace meniscus {

class SceneArchive {
 public:
  /// Throws InputError, naming `name`, if the bytes are no sound zip archive or an entry's name points
  /// outside of it (absolute, or with "..").
  SceneArchive(std::string bytes, std::string name);
  ~SceneArchive();
  SceneArchive(const SceneArchive&) = delete;
  SceneArchive& operator=(const SceneArchive&) = delete;

  /// An entry by its path. Throws InputError if it is not there, is encrypted or damaged, is larger than 4
  /// GiB, or more than 200 times as large as its compressed form, which only a bomb is.
  std::string read(const std::string& entry) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus

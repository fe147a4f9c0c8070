#pragma once
// Reading the small files of tests/data/structures, and text written on the fly.

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "io/structure_reader.h"
#include "tests/support/paths.h"

namespace meniscus::test {

inline std::filesystem::path dataFile(const std::string& name) {
  return projectFile("tests/data/structures/" + name);
}

struct Read {
  StructureFile file;
  Logger logger;
  const Molecule& molecule() const { return file.models.at(0); }
  bool hasNote(std::string_view part) const {
    for (const std::string& note : logger.notes()) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  }
};

inline Read readFile(const std::filesystem::path& path, const StructureOptions& options = {}) {
  Read read;
  read.file = readStructure(path, options, read.logger);
  return read;
}

inline Read readData(const std::string& name, const StructureOptions& options = {}) {
  return readFile(dataFile(name), options);
}

/// The first model of a file of molecules/.
inline Molecule readMolecule(const std::string& name, const StructureOptions& options = {}) {
  return readFile(projectFile("molecules/" + name), options).molecule();
}

/// A file that lives as long as the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, std::string_view bytes)
      : path_(std::filesystem::temp_directory_path() /
              ("meniscus-" + std::to_string(counter()++) + "-" + name)) {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  static std::size_t& counter() {
    static std::size_t count =
        static_cast<std::size_t>(std::filesystem::file_time_type::clock::now().time_since_epoch().count());
    return count;
  }
  std::filesystem::path path_;
};

}  // namespace meniscus::test

#pragma once
// The manifest of a run of many pictures: JSON Lines, one for each picture and for each input that failed,
// written as soon as it is done, so that a run that was killed can be continued.

#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace meniscus {

struct ManifestEntry {
  std::string input, output;  ///< output: empty if the input could not be prepared
  std::string key;            ///< of the input's content, the options and the program
  std::size_t of = 0;         ///< how many pictures the input has
  double milliseconds = 0;
  std::vector<std::string> warnings;
  std::string error;  ///< empty if the picture is done
};

class Manifest {
 public:
  /// Starts a new one, or goes on with the one that is there if `resume`. Lines that are no JSON, as the last
  /// one of a killed run, are passed over. Throws InputError if the file cannot be read or written.
  Manifest(const std::filesystem::path& path, bool resume);
  ~Manifest();
  Manifest(const Manifest&) = delete;
  Manifest& operator=(const Manifest&) = delete;

  /// Whether a picture is there as an earlier run with the same key has left it.
  bool isDone(const std::string& key, const std::string& output) const;
  /// Whether all pictures of an input are.
  bool allDone(const std::string& key) const;

  /// Throws InputError if the line cannot be written.
  void add(const ManifestEntry& entry);

 private:
  struct Finished {
    std::size_t of = 0;
    std::set<std::string> outputs;
  };
  void readOld();

  std::filesystem::path path_;
  std::map<std::string, Finished> finished_;  ///< by key
  std::FILE* file_ = nullptr;
};

}  // namespace meniscus

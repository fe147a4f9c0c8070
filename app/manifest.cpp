#include "app/manifest.h"

#include <cerrno>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/output_file.h"

namespace meniscus {

Manifest::Manifest(const std::filesystem::path& path, bool resume) : path_(path) {
  requireWritable(path);
  if (resume) readOld();
  file_ = std::fopen(path.c_str(), resume ? "a" : "w");
  if (!file_) throwWriteError(path, errno);
}

Manifest::~Manifest() {
  if (file_) std::fclose(file_);
}

void Manifest::readOld() {
  bool whole = true;
  {
    std::ifstream old(path_);
    for (std::string line; std::getline(old, line);) {
      whole = !old.eof();  // the last line ended with a line feed
      const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
      if (!json.is_object() || !json.contains("error") || !json["error"].is_null()) continue;
      if (!json.contains("key") || !json["key"].is_string() || !json.contains("output") ||
          !json["output"].is_string() || !json.contains("of") || !json["of"].is_number_unsigned())
        continue;
      Finished& finished = finished_[json["key"]];
      finished.of = json["of"];
      finished.outputs.insert(json["output"].get<std::string>());
    }
  }
  if (whole) return;
  std::ofstream(path_, std::ios::app) << '\n';  // ends the line that a killed run has left unfinished
}

bool Manifest::isDone(const std::string& key, const std::string& output) const {
  const auto found = finished_.find(key);
  std::error_code none;
  return found != finished_.end() && found->second.outputs.contains(output) &&
         std::filesystem::exists(output, none);
}

bool Manifest::allDone(const std::string& key) const {
  const auto found = finished_.find(key);
  if (found == finished_.end() || found->second.outputs.size() < found->second.of) return false;
  for (const std::string& output : found->second.outputs)
    if (!isDone(key, output)) return false;
  return true;
}

void Manifest::add(const ManifestEntry& entry) {
  nlohmann::ordered_json json;
  json["input"] = entry.input;
  json["output"] = entry.output.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(entry.output);
  json["milliseconds"] = std::round(entry.milliseconds * 10) / 10;
  json["warnings"] = entry.warnings;
  json["error"] = entry.error.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(entry.error);
  json["key"] = entry.key;
  json["of"] = entry.of;
  const std::string line = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0)
    throwWriteError(path_, errno);
}

}  // namespace meniscus

// A RunReport as JSON: what `--stats FILE` writes. Times in seconds unless a key says otherwise.

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/run_report.h"

namespace meniscus {
namespace {

using Json = nlohmann::ordered_json;

Json resources(const std::vector<ResourceStats>& list) {
  Json array = Json::array();
  for (const ResourceStats& resource : list)
    array.push_back({{"name", resource.name}, {"bytes", resource.bytes}});
  return array;
}

Json surfaceStats(const SurfaceStats& s) {
  Json details = Json::object();
  for (const auto& [name, value] : s.details) details[name] = value;
  return {{"method", s.method},
          {"pixels", s.pixels},
          {"pieces", s.pieces},
          {"iterations", s.iterations},
          {"mostIterations", s.mostIterations},
          {"overflow", s.overflow},
          {"grazing", s.grazing},
          {"notConverged", s.notConverged},
          {"details", details}};
}

Json secondsOf(const RunReport& report) {
  return {{"parse", report.parseSeconds},
          {"bonds", report.bondsSeconds},
          {"primitives", report.primitivesSeconds},
          {"context", report.contextSeconds},
          {"upload", report.render.uploadMs / 1000},
          {"compile", report.render.compileMs / 1000},
          {"draw", drawMs(report) / 1000},
          {"readback", report.render.readbackMs / 1000},
          {"encode", report.encodeSeconds},
          {"export", report.meshSeconds},
          {"total", report.totalSeconds}};
}

}  // namespace

std::string statsAsJson(const RunReport& report) {
  Json json;
  json["version"] = version();
  json["backend"] = report.backend;
  json["renderer"] = report.renderer;
  json["width"] = report.size.width;
  json["height"] = report.size.height;
  json["samples"] = report.samples;
  json["pictures"] = Json::array();
  for (const PictureReport& picture : report.pictures)
    json["pictures"].push_back({{"input", picture.input},
                                {"output", picture.output},
                                {"width", picture.size.width},
                                {"height", picture.size.height},
                                {"samples", picture.samples},
                                {"atoms", picture.atoms},
                                {"bonds", picture.bonds},
                                {"spheres", picture.spheres},
                                {"cylinders", picture.cylinders},
                                {"ellipsoids", picture.ellipsoids},
                                {"copies", picture.copies},
                                {"quadricBytes", picture.quadricBytes},
                                {"metaballs", picture.metaballs},
                                {"triangles", picture.triangles}});
  json["failures"] = report.failures;
  json["seconds"] = secondsOf(report);
  json["cpuSeconds"] = report.cpuSeconds;
  json["peakMemoryBytes"] = report.peakMemoryBytes;
  json["tiles"] = report.render.tiles;
  json["passes"] = Json::array();
  for (const PassStats& pass : report.render.passes)
    json["passes"].push_back({{"name", pass.name}, {"runs", pass.runs}, {"milliseconds", pass.milliseconds}});
  json["omissions"] = Json::array();
  for (const OmissionStats& omission : report.render.omissions)
    json["omissions"].push_back({{"what", omission.what}, {"reason", omission.reason}});
  json["surfaces"] = Json::array();
  for (const SurfaceStats& surface : report.render.surfaces)
    json["surfaces"].push_back(surfaceStats(surface));
  json["programs"] = report.render.programs;
  json["buffers"] = resources(report.render.buffers);
  json["textures"] = resources(report.render.textures);
  // File names need not be UTF-8; what is not becomes U+FFFD instead of an exception.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace meniscus

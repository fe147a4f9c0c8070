// A RunReport as text: what `--explain` prints.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/run_report.h"

namespace meniscus {
namespace {

std::string bytesText(std::uint64_t bytes) {
  return bytes < 10'000       ? fmt::format("{} B", bytes)
         : bytes < 10'000'000 ? fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3)
                              : fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

void explainPictures(const RunReport& report, std::string& text) {
  for (const PictureReport& picture : report.pictures)
    fmt::format_to(std::back_inserter(text), "{} -> {}: {} atoms, {} bonds; {} spheres, {} cylinders{}\n",
                   picture.input, picture.output, picture.atoms, picture.bonds, picture.spheres,
                   picture.cylinders,
                   (picture.ellipsoids > 0 ? fmt::format(", {} ellipsoids", picture.ellipsoids) : "") +
                       (picture.metaballs > 0 ? fmt::format(", {} metaballs", picture.metaballs) : "") +
                       (picture.triangles > 0 ? fmt::format(", {} triangles", picture.triangles) : "") +
                       (picture.copies > 0 ? fmt::format("; {} copies share theirs: {}", picture.copies,
                                                         bytesText(picture.quadricBytes))
                                           : ""));
  fmt::format_to(std::back_inserter(text), "{}x{} pixels, {} samples each, {} tile{}\n", report.size.width,
                 report.size.height, report.samples, report.render.tiles,
                 report.render.tiles == 1 ? "" : "s");
  if (!report.backend.empty())
    fmt::format_to(std::back_inserter(text), "drawn by {} ({})\n", report.renderer, report.backend);
}

void explainPasses(const RenderStats& render, std::string& text) {
  text += "\nWhat ran\n";
  for (const PassStats& pass : render.passes)
    fmt::format_to(std::back_inserter(text), "  {:<31}{:>10.2f} ms {:>6}x\n", pass.name, pass.milliseconds,
                   pass.runs);
  text += "\nWhat was left out\n";
  for (const OmissionStats& omission : render.omissions)
    fmt::format_to(std::back_inserter(text), "  {:<31} {}\n", omission.what, omission.reason);
  if (render.omissions.empty()) text += "  nothing\n";
}

void explainSurfaces(const std::vector<SurfaceStats>& surfaces, std::string& text) {
  for (const SurfaceStats& s : surfaces) {
    const double pixels = std::max(1.0, static_cast<double>(s.pixels));
    fmt::format_to(std::back_inserter(text),
                   "\nSurface by {}: {} rays, {:.2f} pieces and {:.2f} iterations a ray (at most {})\n",
                   s.method, s.pixels, static_cast<double>(s.pieces) / pixels,
                   static_cast<double>(s.iterations) / pixels, s.mostIterations);
    fmt::format_to(std::back_inserter(text),
                   "  {} lists that were too short and done again, {} grazing rays, {} not converged\n",
                   s.overflow, s.grazing, s.notConverged);
    for (const auto& [name, value] : s.details)
      fmt::format_to(std::back_inserter(text), "  {:<28}{:>13}\n", name, value);
  }
}

void explainResources(const char* title, const std::vector<ResourceStats>& list, std::string& text) {
  std::uint64_t sum = 0;
  for (const ResourceStats& resource : list) sum += resource.bytes;
  fmt::format_to(std::back_inserter(text), "\n{}: {}, {}\n", title, list.size(), bytesText(sum));
  for (const ResourceStats& resource : list)
    fmt::format_to(std::back_inserter(text), "  {:<28}{:>13}\n", resource.name, bytesText(resource.bytes));
}

void explainTimes(const RunReport& report, std::string& text) {
  const std::pair<const char*, double> parts[] = {{"parse", report.parseSeconds * 1000},
                                                  {"bonds", report.bondsSeconds * 1000},
                                                  {"primitives", report.primitivesSeconds * 1000},
                                                  {"context", report.contextSeconds * 1000},
                                                  {"upload", report.render.uploadMs},
                                                  {"compile", report.render.compileMs},
                                                  {"draw", drawMs(report)},
                                                  {"read back", report.render.readbackMs},
                                                  {"encode", report.encodeSeconds * 1000},
                                                  {"export", report.meshSeconds * 1000}};
  text += "\nTime\n";
  double rest = report.totalSeconds * 1000;
  for (const auto& [name, ms] : parts) {
    rest -= ms;
    fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.2f} ms\n", name, ms);
  }
  fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.2f} ms\n", "everything else", rest);
  fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.2f} ms, {:.3f} s of CPU, {} of memory at most\n",
                 "total", report.totalSeconds * 1000, report.cpuSeconds, bytesText(report.peakMemoryBytes));
}

}  // namespace

std::string explanationOf(const RunReport& report) {
  std::string text;
  explainPictures(report, text);
  explainPasses(report.render, text);
  explainSurfaces(report.render.surfaces, text);
  fmt::format_to(std::back_inserter(text), "\nPrograms: {}\n", report.render.programs.size());
  for (const std::string& program : report.render.programs) text += "  " + program + "\n";
  explainResources("Buffers", report.render.buffers, text);
  explainResources("Textures", report.render.textures, text);
  explainTimes(report, text);
  return text;
}

}  // namespace meniscus

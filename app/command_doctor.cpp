// `meniscus doctor`: every way to OpenGL, whether it works here, and what to do about those that do not.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/window_probe.h"
#include "core/error.h"
#include "render/gl/context.h"

namespace meniscus {
namespace {

constexpr const char* kDescription =
    "Says which ways to OpenGL 4.5 work on this machine, and what to do about the others.\n"
    "'meniscus render' takes the first that works; it needs no window.\n";

constexpr const char* kExamples =
    "  meniscus doctor\n"
    "  meniscus doctor --json\n"
    "  xvfb-run meniscus doctor      # with a virtual display, to try the window\n";

constexpr const char* kWindow = "window";

// What `meniscus render --backend auto` takes.
const BackendReport* chosenFrom(const std::vector<BackendReport>& reports) {
  const auto found = std::find_if(reports.begin(), reports.end(), [](const BackendReport& report) {
    return report.works && report.name != kWindow;
  });
  return found == reports.end() ? nullptr : &*found;
}

std::string asJson(const std::vector<BackendReport>& reports) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["version"] = version();
  const BackendReport* chosen = chosenFrom(reports);
  json["chosen"] = chosen != nullptr ? Json(chosen->name) : Json(nullptr);
  json["backends"] = Json::array();
  for (const BackendReport& report : reports) {
    Json entry = {{"name", report.name}, {"works", report.works}};
    if (report.works) {
      entry["vendor"] = report.vendor;
      entry["renderer"] = report.renderer;
      entry["gl"] = report.glVersion;
      entry["glsl"] = report.glslVersion;
      entry["limits"] = Json::object();
      for (const auto& [name, value] : report.limits) entry["limits"][name] = value;
    } else {
      entry["reason"] = report.reason;
      entry["remedy"] = report.remedy;
    }
    json["backends"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string asText(const std::vector<BackendReport>& reports) {
  std::size_t width = 0;
  for (const BackendReport& report : reports) width = std::max(width, report.name.size());
  std::string text;
  const auto line = [&](const std::string& name, const char* key, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<{}}  {:<10}{}\n", name, width, key, value);
  };
  for (const BackendReport& report : reports) {
    line(report.name, report.works ? "works" : "no", report.works ? report.renderer : report.reason);
    if (!report.works) {
      if (!report.remedy.empty()) line("", "remedy", report.remedy);
    } else {
      line("", "vendor", report.vendor);
      line("", "OpenGL", report.glVersion);
      line("", "GLSL", report.glslVersion);
      for (const auto& [name, value] : report.limits) line("", "limit", fmt::format("{} {}", name, value));
    }
    text += "\n";
  }
  if (const BackendReport* chosen = chosenFrom(reports))
    text += "meniscus render uses: " + chosen->name + "\n";
  return text;
}

}  // namespace

int runDoctor(const std::vector<std::string>& arguments) {
  bool json = false;
  const std::unique_ptr<CLI::App> app = makeCommandLine("doctor", kDescription, kExamples);
  app->add_flag("--json", json, "Print JSON")->group("Other");
  if (!parseCommandLine(*app, arguments)) return 0;

  std::vector<BackendReport> reports = diagnoseBackends();
  reports.push_back(probeWindow());
  const std::string text = json ? asJson(reports) : asText(reports);
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::any_of(reports.begin(), reports.end(), [](const BackendReport& report) { return report.works; }))
    return 0;
  throw GraphicsError("no way to OpenGL 4.5 works here; the remedies above say what to install");
}

}  // namespace meniscus

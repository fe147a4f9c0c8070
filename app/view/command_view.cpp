// `meniscus view`: structure files and scenes in a window.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/option_values.h"
#include "app/render_options.h"
#include "app/view/viewer.h"
#include "core/error.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

constexpr const char* kHelp =
    "Shows structure files (PDB, mmCIF, plain or .gz, BinaryCIF) and MolViewSpec scenes in a window: the\n"
    "picture that `meniscus render` writes, to be turned. H in the window shows what keys and mouse do.\n"
    "\n"
    "Usage: meniscus view [FILE...] [options]\n"
    "\n"
    "Input:\n"
    "  FILE                        Structure files, .mvsj and .mvsx scenes; more can be dropped into the "
    "window\n"
    "\n"
    "Options:\n"
    "  --size WxH                  Pixels of the picture when the window opens [1024x768]\n"
    "  --context auto|glx|egl|osmesa\n"
    "                              How the window itself reaches OpenGL [auto: the first that works]; what\n"
    "                              draws the picture in it is --backend, as for meniscus render\n"
    "  --stats FILE                Write how long the window let its user wait, as JSON, when it is closed\n"
    "  ...                         What says how a picture looks, as for meniscus render: --representation,\n"
    "                              --color, --show, --style, --shadows, ...\n"
    "  -h, --help                  Show this help\n"
    "\n"
    "Examples:\n"
    "  meniscus view 4hhb.cif.gz\n"
    "  meniscus view 4hhb.cif.gz --representation surface --style soft\n";

// What files are written, and how many, is render's business.
void requireNoOutputs(const RenderOptions& o) {
  const std::array<std::pair<const char*, bool>, 8> outputs{{{"--output", !o.output.empty()},
                                                             {"--export", !o.exportMesh.empty()},
                                                             {"--save-scene", !o.saveScene.empty()},
                                                             {"--manifest", !o.manifest.empty()},
                                                             {"--resume", o.resume},
                                                             {"--turntable", o.turntable > 0},
                                                             {"--explain", o.explain},
                                                             {"--time-limit", o.timeLimit > 0}}};
  for (const auto& [name, given] : outputs)
    if (given)
      throw UsageError(
          fmt::format("{}: is for meniscus render; a window writes pictures when it is told (Ctrl S)", name));
}

// Before a window opens; what is wrong within a file is said there.
void requireExists(const std::string& file) {
  if (!std::filesystem::exists(file)) throw InputError(file + ": no such file: check the path");
}

// A window's own option is taken out; the rest is render's.
WindowContext takeContext(std::vector<std::string>& arguments) {
  std::string context = "auto";
  const std::unique_ptr<CLI::App> app = makeCommandLine("view", "", "");
  app->add_option("--context", context, "auto, glx, egl or osmesa")->take_last();
  app->allow_extras();
  if (!parseCommandLine(*app, arguments)) throw UsageError("--help: is no setting");  // it has been shown
  arguments = app->remaining();
  return parseChoice<WindowContext>("--context", context,
                                    {{"auto", WindowContext::automatic},
                                     {"glx", WindowContext::glx},
                                     {"egl", WindowContext::egl},
                                     {"osmesa", WindowContext::osmesa}});
}

}  // namespace

int runView(const std::vector<std::string>& given) {
  const auto isHelp = [](const std::string& argument) { return argument == "--help" || argument == "-h"; };
  if (std::any_of(given.begin(), given.end(), isHelp)) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  std::vector<std::string> arguments = given;
  const WindowContext context = takeContext(arguments);
  RenderOptions options = parseSettings(arguments);
  requireNoOutputs(options);
  std::erase_if(options.given,
                [](const auto& option) { return option.first == "style"; });  // its options stand there, too
  for (const std::string& file : options.files) requireExists(file);
  for (const std::string& scene : options.scenes) requireExists(scene);
  if (!options.statsFile.empty()) requireWritable(options.statsFile);
  Viewer viewer(options, context);
  viewer.run();
  if (!options.statsFile.empty()) writeTextFile(options.statsFile, viewer.statsAsJson());
  return 0;
}

}  // namespace meniscus

#pragma once
// What `meniscus measure` is asked to do: a sweep, from a JSON file or from one of those built in
// (docs/measuring.md describes the keys).

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/render_settings.h"
#include "core/scene.h"

namespace meniscus::measure {

/// Where metaballs come from: exactly one of `molecule`, `balls` and `stability` is given.
struct SceneSpec {
  std::string name;                ///< as in the tables
  std::filesystem::path molecule;  ///< a structure file that exists
  std::string select;              ///< CID selection; empty = all
  glm::ivec3 copies{1};
  std::size_t balls = 0;  ///< so many packed balls (core/generated_scenes.h)
  std::string stability;  ///< name of a recipe; brings its own view
  SurfaceShape shape;     ///< of a molecule
};

struct ViewSpec {
  std::string name = "front";
  glm::dvec3 rotateDeg{0.0};
  double fovDeg = 30;
  double zoom = 1;
  bool orthographic = false;
};

/// One method's line in the diagrams: its points along one parameter.
struct MethodLine {
  std::string method;                     ///< a registered one
  std::map<std::string, double> options;  ///< that stay the same
  std::string parameter;                  ///< that varies; empty = one point
  std::vector<double> values;
  /// In the tables: the method and its options.
  std::string label() const;
};

struct ShadowSpec {
  std::string name;
  std::filesystem::path molecule;
  Representation representation = Representation::spacefill;
  glm::ivec3 copies{1};
  double penumbra = 2;                        ///< [Å]
  std::vector<std::pair<int, int>> settings;  ///< samples, probes
};

struct StabilitySpec {
  ImageSize size{96, 72};
  double timeLimit = 60;            ///< [s] for a cell
  std::vector<std::string> scenes;  ///< names of recipes
};

struct PapersSpec {
  double scale = 1;                    ///< of the papers' picture sizes
  std::size_t mostBalls = 10'000'000;  ///< larger scenes are left out
};

struct Sweep {
  std::string name;
  std::string text;  ///< the JSON, to know it again
  std::uint64_t seed = 1;
  int repetitions = 5, warmUp = 1;
  double budget = 0;    ///< [s]; then fewer repetitions, at least one; 0 = none
  bool images = true;   ///< a picture and error image for each point
  bool layers = false;  ///< OpenEXR files of what was drawn and of the truth
  std::vector<SceneSpec> scenes;
  std::vector<ViewSpec> views;
  std::vector<ImageSize> sizes;
  std::vector<MethodLine> lines;
  std::vector<SceneSpec> scaling;  ///< of growing size, drawn with each method's defaults
  std::vector<ShadowSpec> shadows;
  std::optional<StabilitySpec> stability;
  std::optional<SceneSpec> leavingOut;  ///< the molecule of the table
  std::optional<PapersSpec> papers;
};

/// Reads and checks all of it. `sweep` is a built-in name or a file. Throws InputError or UsageError, one
/// line that names the key.
Sweep loadSweep(const std::string& sweep);

/// The same from text. `where` names it in errors; molecules are looked for in `folder`, then among those
/// that come with the program.
Sweep parseSweep(const std::string& text, const std::string& where, const std::filesystem::path& folder);

struct BuiltInSweep {
  std::string_view name, summary, json;
};
std::span<const BuiltInSweep> builtInSweeps();

/// A structure that comes with the program: in share/meniscus/molecules or molecules of a folder above the
/// executable. Empty if there is none of that name.
std::filesystem::path findMolecule(const std::string& name);

}  // namespace meniscus::measure

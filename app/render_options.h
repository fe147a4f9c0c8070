#pragma once
// What `meniscus render` was asked to do.

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/option_values.h"
#include "app/panels.h"
#include "core/label_sprite.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "io/structure_reader.h"
#include "render/gl/context.h"

namespace meniscus {

struct RenderOptions {
  std::vector<std::string> files;
  std::vector<std::string> scenes;  ///< MolViewSpec files
  std::string output;               ///< pattern, see app/output_name.h

  StructureOptions structure;
  std::string assembly;  ///< empty = the atoms as they stand in the file
  glm::ivec3 replicate{1};

  Representation representation = Representation::spacefill;
  Coloring coloring;
  RadiusSet radii = RadiusSet::bondi;
  std::optional<double> ballScale, stickRadius;  ///< nothing = the representation's own
  double ribbonScale = 1;                        ///< of cartoons, backbones and putty
  double probability = 0.5;                      ///< of displacement ellipsoids, see SceneObject
  SurfaceShape surfaceShape;
  SurfaceSettings surface;
  std::string exportMesh;             ///< pattern of names; empty = no mesh is written
  std::optional<double> meshSpacing;  ///< [Å] nothing = the method's default
  std::vector<ShownApart> shown;      ///< drawn in another way; of several that name an atom the last has it
  std::vector<std::string> hidden;    ///< CIDs of what is not drawn, whatever else names it

  std::vector<std::pair<std::string, std::string>> labels;  ///< CID and text
  std::vector<std::vector<std::string>> measures;  ///< two to four CIDs each: distance, angle, torsion
  double labelSize = 4;                            ///< height of letters, percent of the picture's height
  LabelColors labelColors;
  std::filesystem::path labelFont;  ///< empty = DejaVu Sans

  Orientation orientation;
  glm::dvec3 rotationDeg{0.0};
  bool orthographic = false;
  double fovYDeg = 30;
  double zoom = 1;
  std::string focus;                 ///< CID; empty = everything
  std::optional<glm::dvec3> target;  ///< world point in the middle of the picture [Å]; nothing = fitted
  std::optional<double> distance;    ///< as in Camera [Å]; nothing = fitted
  std::optional<double> nearest, farthest;  ///< as in Camera [Å]; nothing = all is seen

  std::vector<PanelOptions> panels;  ///< none = one picture
  std::optional<double> divider;     ///< of two panels, share of the width; nothing = they are apart

  ImageSize size;
  int samples = 16;
  bool levelOfDetail = true;
  Background background;
  std::optional<double> keyLight, fillLight, ambientLight, highlight;  ///< nothing = the default
  std::optional<glm::dvec3> keyDirection;  ///< the way the key light travels, view space
  ShadowSettings shadows;
  OcclusionSettings occlusion;
  TraceSettings trace;
  std::filesystem::path environmentFile;  ///< picture of what is all around; empty = TraceSettings says
  SilhouetteSettings lines;
  DepthUnsharpSettings depthUnsharp;
  FogSettings fog;
  Layers layers;     ///< EXR; a PNG holds the colour only
  int bitDepth = 8;  ///< PNG: 8 or 16
  double dpi = 0;    ///< 0 = not written

  int jobs = 1;                 ///< inputs that are prepared while others are drawn
  std::string manifest;         ///< JSON Lines about every picture; empty = none
  bool resume = false;          ///< leave out what the manifest says is done
  double timeLimit = 0;         ///< of a picture [s]; 0 = none
  int turntable = 0;            ///< pictures of a turn about the vertical axis; 0 = one picture that stands
  double framesPerSecond = 30;  ///< of a film

  std::string saveScene;        ///< MolViewSpec file to write; empty = none
  bool strict = false;          ///< what a scene has that is not supported is an error
  bool offline = false;         ///< nothing is fetched from the web
  std::filesystem::path cache;  ///< of what was fetched; empty = the usual place

  Backend backend = Backend::automatic;
  QuadricMethod quadrics = QuadricMethod::automatic;
  std::filesystem::path shaderDir;
  bool explain = false;
  std::string statsFile;
  bool quiet = false;

  /// The options that decide what the picture looks like, as given, quoted for a shell: what a picture's
  /// metadata record.
  std::string pictureOptions;
  /// The same by name (without "--") and value; a flag's value is empty.
  std::vector<std::pair<std::string, std::string>> given;
  /// Names of the options given that say nothing of what a picture looks like; of parseSettings() only.
  std::vector<std::string> ofTheRun;
};

/// A word of a command line, quoted for a shell if it must be.
std::string shellQuoted(const std::string& text);

/// Nothing if --help was asked for (it has been printed). Throws UsageError.
std::optional<RenderOptions> parseRenderOptions(const std::vector<std::string>& arguments);

/// Options that a scene gives, without inputs and outputs. Throws UsageError ("--name: ...").
RenderOptions parseSettings(const std::vector<std::string>& arguments);

/// Throws UsageError if the options contradict each other or the name of the output.
void requireSettingsConsistent(const RenderOptions& options);

}  // namespace meniscus

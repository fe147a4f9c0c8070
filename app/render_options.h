#pragma once
// What `meniscus render` was asked to do.

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/option_values.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "io/structure_reader.h"
#include "render/gl/context.h"

namespace meniscus {

struct RenderOptions {
  std::vector<std::string> files;
  std::string output;  ///< pattern, see app/output_name.h

  StructureOptions structure;
  std::string assembly;  ///< empty = the atoms as they stand in the file
  glm::ivec3 replicate{1};

  Representation representation = Representation::spacefill;
  Coloring coloring;
  RadiusSet radii = RadiusSet::bondi;
  std::optional<double> ballScale, stickRadius;  ///< nothing = the representation's own
  double probability = 0.5;                      ///< of displacement ellipsoids, see SceneObject
  SurfaceShape surfaceShape;
  SurfaceSettings surface;
  std::string exportMesh;             ///< pattern of names; empty = no mesh is written
  std::optional<double> meshSpacing;  ///< [Å] nothing = the method's default
  std::vector<ShownApart> shown;      ///< drawn in another way; of several that name an atom the last has it

  Orientation orientation;
  glm::dvec3 rotationDeg{0.0};
  bool orthographic = false;
  double fovYDeg = 30;
  double zoom = 1;
  std::string focus;  ///< CID; empty = everything

  ImageSize size;
  int samples = 16;
  Background background;
  std::optional<double> keyLight, fillLight, ambientLight, highlight;  ///< nothing = the default
  ShadowSettings shadows;
  OcclusionSettings occlusion;
  SilhouetteSettings lines;
  DepthUnsharpSettings depthUnsharp;
  FogSettings fog;
  Layers layers;     ///< EXR; a PNG holds the colour only
  int bitDepth = 8;  ///< PNG: 8 or 16
  double dpi = 0;    ///< 0 = not written

  Backend backend = Backend::automatic;
  QuadricMethod quadrics = QuadricMethod::automatic;
  std::filesystem::path shaderDir;
  bool explain = false;
  std::string statsFile;
  bool quiet = false;

  /// The options that decide what the picture looks like, as given, quoted for a shell: what a picture's
  /// metadata record.
  std::string pictureOptions;
};

/// Nothing if --help was asked for (it has been printed). Throws UsageError.
std::optional<RenderOptions> parseRenderOptions(const std::vector<std::string>& arguments);

}  // namespace meniscus

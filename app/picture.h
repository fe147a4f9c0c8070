#pragma once
// A picture that only needs to be drawn: made from a structure file and options, or from a scene file.

#include <memory>
#include <string>
#include <vector>

#include "app/output_name.h"
#include "app/render_options.h"
#include "core/primitives.h"
#include "core/scene.h"

namespace meniscus {

struct Picture {
  std::string input, output;  ///< names of files; output: empty if only a mesh is wanted
  std::string exported;       ///< the mesh of its surfaces; empty = none
  OutputPlace place;          ///< what `output` was made from
  StructureFormat format = StructureFormat::mmcif;  ///< of `input`, if it is no scene
  RenderOptions options;  ///< size, samples, light, effects and format; not what is drawn
  Scene scene;            ///< with its camera; the light comes from the options
  std::vector<Picture>
      panels;  ///< drawn instead of the scene, by its camera; sizes are the drawer's business
  std::shared_ptr<const Primitives> primitives;  ///< of the scene, if they are there already
  std::string source;                            ///< recorded in the file: what it shows
  std::string command;                           ///< and how it was made

  /// The file that comes of it: the picture's, or the mesh's if there is no picture.
  const std::string& result() const { return output.empty() ? exported : output; }
};

/// What became of one input: its pictures, ready to be drawn, and what is to be said about it.
struct Preparation {
  std::vector<Picture> pictures;
  std::vector<std::string> notes;        ///< oddities that were mended
  std::vector<std::string> unsupported;  ///< what of a scene is not drawn: place and reason
  int modelCount = 1;                    ///< how many models a structure file has
  double parseSeconds = 0, bondsSeconds = 0;
};

}  // namespace meniscus

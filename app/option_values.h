#pragma once
// Values of command-line options from their text. Every function throws UsageError: one line that names the
// option, the value, and what is allowed.

#include <array>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/image.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "io/structure_reader.h"
#include "render/gl/context.h"

namespace meniscus {

/// Which way the camera looks.
struct Orientation {
  enum class Kind { principal, axis, quaternion } kind = Kind::principal;
  int axis = 2;                       ///< for Kind::axis: 0, 1, 2 = down x, y, z
  glm::dquat quaternion{1, 0, 0, 0};  ///< for Kind::quaternion: world axes -> view axes, unit
};

[[noreturn]] void throwBadValue(std::string_view option, std::string_view value, std::string_view allowed);

/// `unit` is shown in the error only ("degrees"); may be empty.
double parseNumber(std::string_view option, std::string_view value, double least, double most,
                   std::string_view unit = {});
int parseInteger(std::string_view option, std::string_view value, int least, int most);
glm::dvec3 parseAngles(std::string_view option, std::string_view value);
glm::dvec3 parsePoint(std::string_view option, std::string_view value);
/// Not zero.
glm::dvec3 parseDirection(std::string_view option, std::string_view value);

/// "WxH", or "N" for a square; each side 1..65535, at most 2^31 - 1 pixels.
ImageSize parseSize(std::string_view option, std::string_view value);

/// "NxMxK", each at least 1, at most a million copies.
glm::ivec3 parseCopies(std::string_view option, std::string_view value);
/// Between 0 and 1, neither included.
double parseProbability(std::string_view option, std::string_view value);

/// "#RGB" or "#RRGGBB"; the # may be missing, because a shell takes an unquoted one for a comment.
std::optional<Rgb> colorFromHex(std::string_view value);

Coloring parseColoring(std::string_view option, std::string_view value);
/// The text that parseColoring() takes for it, without what --carbons says.
std::string coloringName(const Coloring& coloring);
/// Names separated by commas, out of color, albedo, normal, depth, distance, id.
Layers parseLayers(std::string_view option, std::string_view value);
/// Names separated by commas, out of silhouettes, creases and one of chains, residues, atoms; or off. Only
/// these members of `lines` are set.
void parseOutlines(std::string_view option, std::string_view value, SilhouetteSettings& lines);
/// A number of Angstrom, or percent of the picture's smaller side with "%".
void parseUnsharpRadius(std::string_view option, std::string_view value, DepthUnsharpSettings& unsharp);
/// A colour as '#RRGGBB', white or black.
Rgb parseColor(std::string_view option, std::string_view value);
Background parseBackground(std::string_view option, std::string_view value);
Orientation parseOrientation(std::string_view option, std::string_view value);

/// sextic, quartic, or power:N with N an exponent that is allowed.
Kernel parseKernel(std::string_view option, std::string_view value);
Representation parseRepresentation(std::string_view option, std::string_view value);
/// The word that parseRepresentation() takes for it.
std::string_view representationName(Representation representation);

/// NAME=VALUE with a finite number: a surface method's parameter.
std::pair<std::string, double> parseSurfaceOption(std::string_view option, std::string_view value);

/// Atoms that are drawn in a way of their own.
struct ShownApart {
  std::string cid;
  Representation representation;
  std::optional<Coloring> coloring;  ///< nothing = as the rest
};
/// CID=REPRESENTATION or CID=REPRESENTATION:COLOR.
ShownApart parseShown(std::string_view option, std::string_view value);

/// CID=TEXT: what to label, and how.
std::pair<std::string, std::string> parseLabel(std::string_view option, std::string_view value);

/// Two to four CIDs separated by semicolons.
std::vector<std::string> parseMeasure(std::string_view option, std::string_view value);

/// "first", "all" or a letter or digit.
void parseAltloc(std::string_view option, std::string_view value, StructureOptions& options);

/// A model number, or "all".
void parseModel(std::string_view option, std::string_view value, StructureOptions& options);

template <typename Value>
struct Choice {
  std::string_view word;
  Value value;
};

/// Position of `value` among `words`, in any letter case; "-" counts as "_".
std::size_t parseWord(std::string_view option, std::string_view value,
                      std::span<const std::string_view> words);

template <typename Value, std::size_t N>
Value parseChoice(std::string_view option, std::string_view value, const Choice<Value> (&choices)[N]) {
  std::array<std::string_view, N> words;
  for (std::size_t i = 0; i < N; ++i) words[i] = choices[i].word;
  return choices[parseWord(option, value, words)].value;
}

/// auto, egl or osmesa.
Backend parseBackend(std::string_view option, std::string_view value);

}  // namespace meniscus

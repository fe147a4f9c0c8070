#include "app/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr int kMaxSide = 65535;
constexpr long long kMaxPixels = 0x7fffffff;
constexpr long long kMaxCopies = 1'000'000;

constexpr std::array<Choice<ColorScheme>, 6> kSchemes{{
    {"element", ColorScheme::element},
    {"chain", ColorScheme::chain},
    {"residue", ColorScheme::residue},
    {"bfactor", ColorScheme::bFactor},
    {"plddt", ColorScheme::plddt},
    {"rainbow", ColorScheme::rainbow},
}};

constexpr Choice<Representation> kRepresentations[] = {
    {"spacefill", Representation::spacefill}, {"ball_and_stick", Representation::ballAndStick},
    {"licorice", Representation::licorice},   {"ellipsoids", Representation::ellipsoids},
    {"surface", Representation::surface},     {"cartoon", Representation::cartoon},
    {"backbone", Representation::backbone},   {"putty", Representation::putty}};

/// The whole text as a number; nothing if it is not one.
template <typename Number>
std::optional<Number> numberFrom(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find_first_of(separators);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Exactly `count` finite numbers separated by commas; empty if the text is anything else.
std::vector<double> numberList(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ",")) {
    const std::optional<double> number = numberFrom<double>(part);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers.size() == count ? numbers : std::vector<double>{};
}

std::string folded(std::string_view word) {
  std::string result(word);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-') c = '_';
  }
  return result;
}

}  // namespace

void throwBadValue(std::string_view option, std::string_view value, std::string_view allowed) {
  throw UsageError(fmt::format("{}: '{}' is not allowed; give {}", option, value, allowed));
}

double parseNumber(std::string_view option, std::string_view value, double least, double most,
                   std::string_view unit) {
  const std::optional<double> number = numberFrom<double>(value);
  if (!number || !(*number >= least && *number <= most))
    throwBadValue(option, value,
                  fmt::format("a number from {} to {}{}{}", least, most, unit.empty() ? "" : " ", unit));
  return *number;
}

double parseProbability(std::string_view option, std::string_view value) {
  const std::optional<double> number = numberFrom<double>(value);
  if (!number || !(*number > 0 && *number < 1))
    throwBadValue(option, value, "a number between 0 and 1, as 0.5 or 0.99");
  return *number;
}

int parseInteger(std::string_view option, std::string_view value, int least, int most) {
  const std::optional<int> number = numberFrom<int>(value);
  if (!number || *number < least || *number > most)
    throwBadValue(option, value, fmt::format("a whole number from {} to {}", least, most));
  return *number;
}

glm::dvec3 parseAngles(std::string_view option, std::string_view value) {
  const std::vector<double> n = numberList(value, 3);
  if (n.empty()) throwBadValue(option, value, "three angles in degrees, for example 0,90,0");
  return {n[0], n[1], n[2]};
}

glm::dvec3 parsePoint(std::string_view option, std::string_view value) {
  const std::vector<double> n = numberList(value, 3);
  if (n.empty()) throwBadValue(option, value, "three coordinates in Angstrom, for example 10,20.5,-3");
  return {n[0], n[1], n[2]};
}

glm::dvec3 parseDirection(std::string_view option, std::string_view value) {
  const std::vector<double> n = numberList(value, 3);
  const glm::dvec3 direction = n.empty() ? glm::dvec3(0.0) : glm::dvec3(n[0], n[1], n[2]);
  if (!(glm::length(direction) > 1e-6 && glm::length(direction) < 1e6))
    throwBadValue(option, value, "three numbers that are not all zero, for example 0.45,-0.6,-0.8");
  return direction;
}

ImageSize parseSize(std::string_view option, std::string_view value) {
  const std::vector<std::string_view> sides = split(value, "xX");
  const std::optional<long long> width = numberFrom<long long>(sides.front());
  const std::optional<long long> height = numberFrom<long long>(sides.back());
  if (sides.size() > 2 || !width || !height || *width < 1 || *height < 1 || *width > kMaxSide ||
      *height > kMaxSide)
    throwBadValue(option, value,
                  fmt::format("WIDTHxHEIGHT in pixels, each from 1 to {}, for example 1920x1080", kMaxSide));
  if (*width * *height > kMaxPixels)
    throwBadValue(option, value, fmt::format("a picture of at most {} pixels", kMaxPixels));
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

glm::ivec3 parseCopies(std::string_view option, std::string_view value) {
  const std::vector<std::string_view> parts = split(value, "xX");
  glm::ivec3 copies(1);
  long long product = 1;
  bool valid = parts.size() == 3;
  for (int i = 0; valid && i < 3; ++i) {
    const std::optional<int> n = numberFrom<int>(parts[static_cast<std::size_t>(i)]);
    valid = n && *n >= 1 && *n <= kMaxCopies && product * *n <= kMaxCopies;
    if (!valid) break;
    copies[i] = *n;
    product *= *n;
  }
  if (!valid)
    throwBadValue(
        option, value,
        fmt::format("NxMxK, whole numbers from 1, at most {} copies, for example 3x3x3", kMaxCopies));
  return copies;
}

std::optional<Rgb> colorFromHex(std::string_view value) {
  if (value.starts_with('#')) value.remove_prefix(1);
  Rgb rgb = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), rgb, 16);
  if (error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  if (value.size() == 6) return rgb;
  if (value.size() != 3) return std::nullopt;
  return (rgb >> 8 & 0xF) * 0x110000 + (rgb >> 4 & 0xF) * 0x1100 + (rgb & 0xF) * 0x11;
}

Coloring parseColoring(std::string_view option, std::string_view value) {
  Coloring coloring;
  const auto* scheme = std::find_if(kSchemes.begin(), kSchemes.end(),
                                    [word = folded(value)](const auto& entry) { return entry.word == word; });
  if (scheme != kSchemes.end()) {
    coloring.scheme = scheme->value;
  } else if (const std::optional<Rgb> rgb = colorFromHex(value)) {
    coloring.scheme = ColorScheme::uniform;
    coloring.uniform = *rgb;
  } else {
    throwBadValue(option, value, "element, chain, residue, bfactor, plddt, rainbow or a colour as '#RRGGBB'");
  }
  return coloring;
}

std::string coloringName(const Coloring& coloring) {
  if (coloring.scheme == ColorScheme::uniform) return fmt::format("#{:06X}", coloring.uniform);
  return std::string(std::find_if(kSchemes.begin(), kSchemes.end(), [&](const auto& entry) {
                       return entry.value == coloring.scheme;
                     })->word);
}

Layers parseLayers(std::string_view option, std::string_view value) {
  Layers layers;
  layers.color = false;
  for (const std::string_view word : split(value, ",")) {
    bool Layers::*const layer = parseChoice<bool Layers::*>(option, word,
                                                            {{"color", &Layers::color},
                                                             {"albedo", &Layers::albedo},
                                                             {"normal", &Layers::normal},
                                                             {"depth", &Layers::depth},
                                                             {"distance", &Layers::distance},
                                                             {"id", &Layers::id}});
    layers.*layer = true;
  }
  return layers;
}

void parseOutlines(std::string_view option, std::string_view value, SilhouetteSettings& lines) {
  static constexpr std::array<std::string_view, 6> kWords{"silhouettes", "creases", "chains",
                                                          "residues",    "atoms",   "off"};
  lines.silhouettes = lines.creases = false;
  lines.groups = LineGroups::none;
  const std::vector<std::string_view> words = split(value, ",");
  for (const std::string_view word : words) {
    const std::size_t which = parseWord(option, word, kWords);
    if (which == 5 && words.size() > 1) throwBadValue(option, value, "off alone, or names of lines");
    // Where residues border on each other, chains do, too: the finest division counts.
    constexpr LineGroups kGroups[] = {LineGroups::chains, LineGroups::residues, LineGroups::atoms};
    if (which >= 2 && which <= 4) lines.groups = std::max(lines.groups, kGroups[which - 2]);
    lines.silhouettes = lines.silhouettes || which == 0;
    lines.creases = lines.creases || which == 1;
  }
}

void parseUnsharpRadius(std::string_view option, std::string_view value, DepthUnsharpSettings& unsharp) {
  unsharp.radiusInAngstrom = !value.ends_with('%');
  if (unsharp.radiusInAngstrom) {
    unsharp.radius = parseNumber(option, value, 0.001, 100000, "Angstrom, or percent as in 2%");
  } else {
    unsharp.radius =
        0.01 * parseNumber(option, value.substr(0, value.size() - 1), 0.01, 50, "percent of the picture");
  }
}

Rgb parseColor(std::string_view option, std::string_view value) {
  const std::string word = folded(value);
  if (word == "white") return 0xFFFFFF;
  if (word == "black") return 0x000000;
  if (const std::optional<Rgb> rgb = colorFromHex(value)) return *rgb;
  throwBadValue(option, value, "white, black or a colour as '#RRGGBB'");
}

Background parseBackground(std::string_view option, std::string_view value) {
  const std::string word = folded(value);
  if (word == "white") return {0xFFFFFF, false};
  if (word == "black") return {0x000000, false};
  if (word == "transparent") return {0x000000, true};
  if (const std::optional<Rgb> rgb = colorFromHex(value)) return {*rgb, false};
  throwBadValue(option, value, "white, black, transparent or a colour as '#RRGGBB'");
}

Orientation parseOrientation(std::string_view option, std::string_view value) {
  const std::string word = folded(value);
  if (word == "principal") return {};
  if (word == "x" || word == "y" || word == "z") return {Orientation::Kind::axis, word[0] - 'x'};
  const std::vector<double> n = numberList(value, 4);
  const glm::dquat quaternion = n.empty() ? glm::dquat(0, 0, 0, 0) : glm::dquat(n[0], n[1], n[2], n[3]);
  const double length = glm::length(quaternion);
  if (!std::isfinite(length) || length < 1e-6)
    throwBadValue(option, value, "principal, x, y, z or a quaternion W,X,Y,Z that is not zero");
  return {Orientation::Kind::quaternion, 2, quaternion / length};
}

Kernel parseKernel(std::string_view option, std::string_view value) {
  const std::string word = folded(value);
  if (word == "sextic") return {KernelShape::sextic};
  if (word == "quartic") return {KernelShape::quartic};
  const std::optional<int> exponent =
      word.starts_with("power:") ? numberFrom<int>(std::string_view(word).substr(6)) : std::nullopt;
  if (!exponent || *exponent < kLeastKernelExponent || *exponent > kMostKernelExponent)
    throwBadValue(option, value,
                  fmt::format("sextic, quartic or power:N with N from {} to {}", kLeastKernelExponent,
                              kMostKernelExponent));
  return {KernelShape::power, *exponent};
}

Representation parseRepresentation(std::string_view option, std::string_view value) {
  return parseChoice(option, value, kRepresentations);
}

std::string_view representationName(Representation representation) {
  return std::find_if(std::begin(kRepresentations), std::end(kRepresentations),
                      [&](const auto& entry) { return entry.value == representation; })
      ->word;
}

std::pair<std::string, double> parseSurfaceOption(std::string_view option, std::string_view value) {
  const std::size_t equals = value.find('=');
  const std::optional<double> number =
      equals == std::string_view::npos ? std::nullopt : numberFrom<double>(value.substr(equals + 1));
  if (!number || !std::isfinite(*number) || equals == 0)
    throwBadValue(option, value, "NAME=NUMBER, as in tolerance=0.0001");
  return {std::string(value.substr(0, equals)), *number};
}

std::pair<std::string, std::string> parseLabel(std::string_view option, std::string_view value) {
  const std::size_t equals = value.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == value.size())
    throwBadValue(option, value, "CID=TEXT, as in '(HEM)=heme'");
  return {std::string(value.substr(0, equals)), std::string(value.substr(equals + 1))};
}

ShownApart parseShown(std::string_view option, std::string_view value) {
  const std::size_t equals = value.rfind('=');
  if (equals == std::string_view::npos || equals == 0)
    throwBadValue(option, value,
                  "CID=REPRESENTATION or CID=REPRESENTATION:COLOR, as in '(HEM)=licorice:element'");
  const std::string_view how = value.substr(equals + 1);
  const std::size_t colon = how.find(':');
  ShownApart shown{
      std::string(value.substr(0, equals)), parseRepresentation(option, how.substr(0, colon)), {}};
  if (colon != std::string_view::npos) shown.coloring = parseColoring(option, how.substr(colon + 1));
  return shown;
}

std::vector<std::string> parseMeasure(std::string_view option, std::string_view value) {
  std::vector<std::string> cids;
  for (const std::string_view cid : split(value, ";")) cids.emplace_back(cid);
  const bool empty =
      std::any_of(cids.begin(), cids.end(), [](const std::string& cid) { return cid.empty(); });
  if (empty || cids.size() < 2 || cids.size() > 4)
    throwBadValue(option, value, "two, three or four selections, for example '//A/10/CA;//A/20/CA'");
  return cids;
}

void parseAltloc(std::string_view option, std::string_view value, StructureOptions& options) {
  const std::string word = folded(value);
  if (word == "first") {
    options.altlocs = Altlocs::first;
  } else if (word == "all") {
    options.altlocs = Altlocs::all;
  } else if (value.size() == 1 && value[0] > ' ' && value[0] < '\x7f') {
    options.altlocs = Altlocs::named;
    options.altloc = value[0];
  } else {
    throwBadValue(option, value, "first, all or the letter of a location, for example A");
  }
}

void parseModel(std::string_view option, std::string_view value, StructureOptions& options) {
  options.allModels = folded(value) == "all";
  options.model.reset();
  if (options.allModels) return;
  options.model = numberFrom<int>(value);
  if (!options.model) throwBadValue(option, value, "a model number of the file or all");
}

std::size_t parseWord(std::string_view option, std::string_view value,
                      std::span<const std::string_view> words) {
  const auto found = std::find(words.begin(), words.end(), folded(value));
  if (found == words.end())
    throwBadValue(option, value,
                  fmt::format("{} or {}", fmt::join(words.first(words.size() - 1), ", "), words.back()));
  return static_cast<std::size_t>(found - words.begin());
}

Backend parseBackend(std::string_view option, std::string_view value) {
  return parseChoice<Backend>(
      option, value, {{"auto", Backend::automatic}, {"egl", Backend::egl}, {"osmesa", Backend::osmesa}});
}

}  // namespace meniscus

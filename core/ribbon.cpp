#include "core/ribbon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "core/backbone.h"
#include "core/secondary_structure.h"

namespace meniscus {
namespace {

// Half widths and half thicknesses [Å]. Choices, near those in common use.
constexpr double kTube = 0.3;
constexpr double kHelixWidth = 1.3, kHelixThickness = 0.24;
constexpr double kStrandWidth = 1.0, kStrandThickness = 0.22, kArrowWidth = 1.7, kArrowTip = 0.2;
constexpr double kNucleicWidth = 1.0, kNucleicThickness = 0.3, kRung = 0.35;
constexpr double kThinPutty = 0.2, kThickPutty = 1.5;
constexpr double kThinTube = 0.19;
// Shares of an interval between residues in which a helix widens, and a tube gets thin before a strand.
constexpr double kWidening = 0.8, kThinning = 0.35;

// Steps from residue to residue, even: colours change half-way. With 12, the chords of a helix lie 0.006 Å
// beneath its arc; with 16 around, those of a tube as much.
constexpr int kSteps = 12, kAround = 16;
constexpr double kFillSpacing = 0.4;  // of the balls within [Å]

enum class Piece : std::uint8_t { tube, strand, arrow };

glm::dvec3 anyPerpendicular(const glm::dvec3& v) {
  const glm::dvec3 a = glm::abs(v);
  const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                          : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                   : glm::dvec3(0, 0, 1);
  const glm::dvec3 across = glm::cross(v, axis);
  const double length = glm::length(across);
  return length > 0 ? across / length : axis;
}

/// Catmull and Rom's spline through values at 0, 1, ..., continued straight beyond the ends.
template <typename T>
T splineAt(const std::vector<T>& values, double u) {
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  const std::ptrdiff_t i = std::clamp(static_cast<std::ptrdiff_t>(std::floor(u)), std::ptrdiff_t{0},
                                      std::max<std::ptrdiff_t>(last - 1, 0));
  const auto at = [&](std::ptrdiff_t k) {
    if (k < 0) return values[0] * 2.0 - values[static_cast<std::size_t>(std::min<std::ptrdiff_t>(1, last))];
    if (k > last)
      return values[static_cast<std::size_t>(last)] * 2.0 -
             values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(last - 1, 0))];
    return values[static_cast<std::size_t>(k)];
  };
  const T a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
  const double t = u - static_cast<double>(i);
  return b + (c - a) * (0.5 * t) + (a * 2.0 - b * 5.0 + c * 4.0 - d) * (0.5 * t * t) +
         (b * 3.0 - a - c * 3.0 + d) * (0.5 * t * t * t);
}

double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// One backbone's ribbon.
class Sweep {
 public:
  Sweep(const Molecule& molecule, const Backbone& backbone, const std::vector<SecondaryStructure>& secondary,
        const std::vector<double>& puttyRadii, RibbonStyle style, double size, Ribbon& out);
  void draw(const std::vector<bool>& chosen);

 private:
  /// The section of a ribbon: its middle, its unit axes, its half width and half thickness.
  struct Section {
    glm::dvec3 place, side, up;
    glm::dvec2 extent{1.0};
    glm::dvec3 point(const glm::dvec2& at) const {
      return place + extent.x * at.x * side + extent.y * at.y * up;
    }
  };
  /// Around the section, in units of its extent.
  using Outline = std::function<glm::dvec2(double)>;
  void chooseStates(const std::vector<SecondaryStructure>& secondary);
  void findPath();
  void findSides();
  void drawRange(double from, double to);
  void drawTube(double from, double to);
  void drawStrand(double from, double to, Piece piece);
  void addPatch(double from, double to, Piece piece, int across, bool around, const Outline& outline);
  void addCaps(double from, double to, Piece piece, int corners, const Outline& outline);
  void fill(double from, double to, Piece piece);
  Section sectionAt(double u, double from, double to, Piece piece) const;
  glm::dvec2 tubeExtent(double u) const;
  double strandWidth(double u, Piece piece) const;
  Piece pieceOf(std::size_t interval) const;
  std::uint32_t atomAt(double u) const;
  std::vector<double> stations(double from, double to) const;

  const Molecule& m_;
  const Backbone& backbone_;
  RibbonStyle style_;
  double size_;
  Ribbon& out_;
  std::vector<SecondaryStructure> states_;
  std::vector<double> radii_;  // of putty
  std::vector<glm::dvec3> path_, sides_;
};

Sweep::Sweep(const Molecule& molecule, const Backbone& backbone,
             const std::vector<SecondaryStructure>& secondary, const std::vector<double>& puttyRadii,
             RibbonStyle style, double size, Ribbon& out)
    : m_(molecule), backbone_(backbone), style_(style), size_(size), out_(out) {
  chooseStates(secondary);
  for (const BackboneResidue& b : backbone.residues)
    radii_.push_back(puttyRadii.empty() ? 0.0 : puttyRadii[b.residue]);
  findPath();
  findSides();
}

// Helices shorter than three residues and strands shorter than two are no shapes.
void Sweep::chooseStates(const std::vector<SecondaryStructure>& secondary) {
  for (const BackboneResidue& b : backbone_.residues)
    states_.push_back(style_ == RibbonStyle::putty || backbone_.nucleic ? SecondaryStructure::coil
                                                                        : secondary[b.residue]);
  for (std::size_t i = 0; i < states_.size();) {
    std::size_t end = i + 1;
    while (end < states_.size() && states_[end] == states_[i]) ++end;
    const std::size_t least = states_[i] == SecondaryStructure::helix ? 3 : 2;
    if (end - i < least)
      std::fill(states_.begin() + static_cast<std::ptrdiff_t>(i),
                states_.begin() + static_cast<std::ptrdiff_t>(end), SecondaryStructure::coil);
    i = end;
  }
}

void Sweep::findPath() {
  for (const BackboneResidue& b : backbone_.residues) path_.push_back(m_.positions[b.trace]);
  // A thick tube would fold where the trace turns sharply.
  for (int pass = 0; pass < (style_ == RibbonStyle::putty ? 3 : 0); ++pass) {
    const std::vector<glm::dvec3> before = path_;
    for (std::size_t i = 1; i + 1 < path_.size(); ++i)
      path_[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
  }
  // Strands are pleated; a ribbon is not.
  const std::vector<glm::dvec3> plain = path_;
  for (std::size_t i = 1; i + 1 < path_.size(); ++i)
    if (states_[i] == SecondaryStructure::strand && states_[i - 1] == states_[i] &&
        states_[i + 1] == states_[i])
      path_[i] = 0.25 * plain[i - 1] + 0.5 * plain[i] + 0.25 * plain[i + 1];
}

void Sweep::findSides() {
  const std::size_t count = path_.size();
  std::vector<glm::dvec3> across(count,
                                 glm::dvec3(0.0));  // of the peptide (or sugar) that begins at a residue
  glm::dvec3 last(0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const BackboneResidue& b = backbone_.residues[i];
    const std::size_t j = i + 1 < count ? i + 1 : i;
    const std::size_t h = j > i ? i : (i > 0 ? i - 1 : i);
    const glm::dvec3 along =
        m_.positions[backbone_.residues[j].trace] - m_.positions[backbone_.residues[h].trace];
    const std::uint32_t partner = backbone_.nucleic ? b.c1 : b.o;
    glm::dvec3 side(0.0);
    if (partner != kNoAtom) {
      const glm::dvec3 normal = glm::cross(along, m_.positions[partner] - m_.positions[b.trace]);
      // In the plane of the peptide; but across the sugars, which point to the helix's axis.
      side = backbone_.nucleic ? normal : glm::cross(normal, along);
    }
    const double length = glm::length(side);
    side = length > 1e-6 ? side / length : last;
    if (glm::length(side) < 0.5) side = anyPerpendicular(along);
    if (glm::dot(side, last) < 0) side = -side;
    across[i] = last = side;
  }
  for (std::size_t i = 0; i < count; ++i) {
    // The residue lies between two peptides; a strand's sides are evened out as its path is.
    glm::dvec3 sum = across[i];
    if (i > 0 && !backbone_.nucleic) sum += across[i - 1];
    if (states_[i] == SecondaryStructure::strand) {
      if (i > 1) sum += 0.5 * across[i - 2];
      if (i + 1 < count) sum += 0.5 * across[i + 1];
    }
    const double length = glm::length(sum);
    sides_.push_back(length > 1e-6 ? sum / length : across[i]);
  }
}

// Of a piece from..to: at its end it is still this one.
Sweep::Section Sweep::sectionAt(double u, double from, double to, Piece piece) const {
  constexpr double kStep = 1e-4;
  Section section;
  section.place = splineAt(path_, u);
  glm::dvec3 along = splineAt(path_, u + kStep) - splineAt(path_, u - kStep);
  const double length = glm::length(along);
  along = length > 0 ? along / length : glm::dvec3(0, 0, 1);
  glm::dvec3 side = splineAt(sides_, u);
  side -= glm::dot(side, along) * along;
  const double sideLength = glm::length(side);
  section.side = sideLength > 1e-6 ? side / sideLength : anyPerpendicular(along);
  section.up = glm::cross(along, section.side);
  section.extent = piece == Piece::tube
                       ? tubeExtent(u)
                       : glm::dvec2(strandWidth(std::clamp(u, from, std::max(from, to - 1e-9)), piece),
                                    kStrandThickness * size_);
  return section;
}

Piece Sweep::pieceOf(std::size_t interval) const {
  const bool strand =
      states_[interval] == SecondaryStructure::strand && states_[interval + 1] == SecondaryStructure::strand;
  if (!strand) return Piece::tube;
  const bool ends = interval + 2 >= states_.size() || states_[interval + 2] != SecondaryStructure::strand;
  return ends ? Piece::arrow : Piece::strand;
}

/// Half the width and half the thickness of a tube.
glm::dvec2 Sweep::tubeExtent(double u) const {
  if (style_ == RibbonStyle::putty)
    return glm::dvec2(std::max(splineAt(radii_, u), 0.5 * kThinPutty)) * size_;
  if (backbone_.nucleic) return glm::dvec2(kNucleicWidth, kNucleicThickness) * size_;
  const auto last = static_cast<std::ptrdiff_t>(states_.size()) - 1;
  const auto isHelix = [&](std::ptrdiff_t i) {
    return i >= 0 && i <= last && states_[static_cast<std::size_t>(i)] == SecondaryStructure::helix;
  };
  const auto i = static_cast<std::ptrdiff_t>(std::floor(u)), j = static_cast<std::ptrdiff_t>(std::ceil(u));
  double share = 0;
  if (isHelix(i) && isHelix(j)) {
    share = 1;
    if (!isHelix(i - 1)) share = std::min(share, smoothStep((u - static_cast<double>(i)) / kWidening));
    if (!isHelix(j + 1)) share = std::min(share, smoothStep((static_cast<double>(j) - u) / kWidening));
  }
  // A tube goes thin into a strand, so that its end does not show.
  const auto isStrand = [&](std::ptrdiff_t k) {
    return k >= 0 && k <= last && states_[static_cast<std::size_t>(k)] == SecondaryStructure::strand;
  };
  double thin = 1;
  if (isStrand(i)) thin = std::min(thin, smoothStep((u - static_cast<double>(i)) / kThinning));
  if (isStrand(j)) thin = std::min(thin, smoothStep((static_cast<double>(j) - u) / kThinning));
  const double tube = glm::mix(kThinTube, kTube, thin);
  return glm::mix(glm::dvec2(tube), glm::dvec2(kHelixWidth, kHelixThickness), share) * size_;
}

double Sweep::strandWidth(double u, Piece piece) const {
  if (piece != Piece::arrow) return kStrandWidth * size_;
  const double begin = std::min(std::floor(u), static_cast<double>(states_.size()) - 2);
  return glm::mix(kArrowWidth, kArrowTip, std::clamp(u - begin, 0.0, 1.0)) * size_;
}

std::uint32_t Sweep::atomAt(double u) const {
  const auto i = std::clamp(static_cast<std::ptrdiff_t>(std::floor(u + 0.5)), std::ptrdiff_t{0},
                            static_cast<std::ptrdiff_t>(path_.size()) - 1);
  return backbone_.residues[static_cast<std::size_t>(i)].trace;
}

std::vector<double> Sweep::stations(double from, double to) const {
  const int steps = std::max(1, static_cast<int>(std::lround((to - from) * kSteps)));
  std::vector<double> u;
  for (int i = 0; i <= steps; ++i) u.push_back(from + (to - from) * i / steps);
  return u;
}

// A piece of surface: over from..to along the backbone and over 0..1 along an outline of the section, which
// goes counter-clockwise seen against the backbone's direction and is a ring if `around`.
void Sweep::addPatch(double from, double to, Piece piece, int across, bool around, const Outline& outline) {
  constexpr double kStep = 1e-4;
  const std::vector<double> us = stations(from, to);
  const auto first = static_cast<std::uint32_t>(out_.vertices.size());
  const int perRow = around ? across : across + 1;
  std::vector<glm::dvec2> at, turn;
  for (int k = 0; k < perRow; ++k) {
    const double v = static_cast<double>(k) / across;
    at.push_back(outline(v));
    turn.push_back(outline(v + kStep) - outline(v - kStep));
  }
  for (const double u : us) {
    const Section here = sectionAt(u, from, to, piece);
    const Section low = sectionAt(std::max(u - kStep, from), from, to, piece),
                  high = sectionAt(std::min(u + kStep, to), from, to, piece);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const glm::dvec3 along = high.point(at[k]) - low.point(at[k]);
      const glm::dvec3 over = here.point(turn[k]) - here.place;
      const glm::dvec3 normal = glm::cross(over, along);
      const double length = glm::length(normal);
      out_.vertices.push_back({here.point(at[k]), length > 0 ? normal / length : here.up});
    }
  }
  for (std::size_t row = 0; row + 1 < us.size(); ++row) {
    const std::uint32_t atom = atomAt(0.5 * (us[row] + us[row + 1]));
    for (int k = 0; k < across; ++k) {
      const auto vertex = [&](std::size_t r, int column) {
        return first + static_cast<std::uint32_t>(r) * static_cast<std::uint32_t>(perRow) +
               static_cast<std::uint32_t>(column % perRow);
      };
      out_.triangles.push_back({vertex(row, k), vertex(row + 1, k + 1), vertex(row + 1, k), atom});
      out_.triangles.push_back({vertex(row, k), vertex(row, k + 1), vertex(row + 1, k + 1), atom});
    }
  }
}

// Flat ends, facing away from the piece.
void Sweep::addCaps(double from, double to, Piece piece, int corners, const Outline& outline) {
  for (const bool atEnd : {false, true}) {
    const Section section = sectionAt(atEnd ? to : from, from, to, piece);
    const glm::dvec3 along = glm::cross(section.side, section.up);
    const glm::dvec3 normal = atEnd ? along : -along;
    const auto center = static_cast<std::uint32_t>(out_.vertices.size());
    out_.vertices.push_back({section.place, normal});
    for (int k = 0; k < corners; ++k)
      out_.vertices.push_back({section.point(outline(static_cast<double>(k) / corners)), normal});
    const std::uint32_t atom = atomAt(atEnd ? to - 1e-6 : from + 1e-6);
    for (int k = 0; k < corners; ++k) {
      const std::uint32_t a = center + 1 + static_cast<std::uint32_t>(k),
                          b = center + 1 + static_cast<std::uint32_t>((k + 1) % corners);
      out_.triangles.push_back(atEnd ? Ribbon::Triangle{center, a, b, atom}
                                     : Ribbon::Triangle{center, b, a, atom});
    }
  }
}

void Sweep::drawTube(double from, double to) {
  const Outline ellipse = [](double v) {
    const double angle = 2 * glm::pi<double>() * v;
    return glm::dvec2(std::cos(angle), std::sin(angle));
  };
  addPatch(from, to, Piece::tube, kAround, true, ellipse);
  addCaps(from, to, Piece::tube, kAround, ellipse);
}

void Sweep::drawStrand(double from, double to, Piece piece) {
  constexpr std::array<glm::dvec2, 4> kCorners{{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (std::size_t side = 0; side < 4; ++side)
    addPatch(from, to, piece, 1, false,
             [a = kCorners[side], b = kCorners[(side + 1) % 4]](double v) { return glm::mix(a, b, v); });
  addCaps(from, to, piece, 4,
          [&](double v) { return kCorners[static_cast<std::size_t>(std::lround(4 * v)) % 4]; });
}

void Sweep::fill(double from, double to, Piece piece) {
  for (const double u : stations(from, to)) {
    const Section section = sectionAt(u, from, to, piece);
    const glm::dvec2 extent = section.extent;
    const double radius = std::min(extent.x, extent.y), reach = extent.x - radius;
    const int beside = static_cast<int>(std::ceil(reach / (kFillSpacing * size_)));
    for (int k = -beside; k <= beside; ++k) {
      const double x = beside > 0 ? reach * k / beside : 0.0;
      // Within an ellipse there is less room towards its rim.
      const double share = piece == Piece::tube ? 1 - x * x / (extent.x * extent.x) : 1.0;
      out_.filling.push_back({section.place + x * section.side, 0.8 * radius * std::sqrt(share), atomAt(u)});
    }
  }
}

void Sweep::drawRange(double from, double to) {
  const auto last = static_cast<double>(path_.size() - 1);
  for (double begin = from; begin < to;) {
    const auto interval = static_cast<std::size_t>(std::min(std::floor(begin), last - 1));
    const Piece piece = pieceOf(interval);
    std::size_t end = interval + 1;
    while (piece != Piece::arrow && end + 1 < path_.size() && pieceOf(end) == piece) ++end;
    const double stop = std::min(to, static_cast<double>(end));
    if (piece == Piece::tube) {
      drawTube(begin, stop);
    } else {
      drawStrand(begin, stop, piece);
    }
    fill(begin, stop, piece);
    begin = stop;
  }
}

void Sweep::draw(const std::vector<bool>& chosen) {
  const std::size_t count = path_.size();
  const auto isChosen = [&](std::size_t i) { return chosen.empty() || chosen[backbone_.residues[i].trace]; };
  for (std::size_t i = 0; i < count; ++i) {
    if (!isChosen(i)) continue;
    const BackboneResidue& b = backbone_.residues[i];
    if (count == 1) out_.lone.push_back({path_[0], kTube * size_, b.trace});
    if (backbone_.nucleic && style_ == RibbonStyle::cartoon && b.base != kNoAtom)
      out_.rungs.push_back({path_[i], m_.positions[b.base], kRung * size_, b.trace, b.base});
  }
  if (count < 2) return;
  for (std::size_t i = 0; i < count;) {
    std::size_t end = i;
    while (end < count && isChosen(end)) ++end;
    if (end > i)
      drawRange(std::max(static_cast<double>(i) - 0.5, 0.0),
                std::min(static_cast<double>(end) - 0.5, static_cast<double>(count - 1)));
    i = std::max(end, i + 1);
  }
}

/// By residue: from the lowest to the highest B factors of the traces, without the outliers.
std::vector<double> puttyRadii(const Molecule& molecule, const std::vector<Backbone>& backbones) {
  std::vector<float> sorted;
  for (const Backbone& backbone : backbones)
    for (const BackboneResidue& b : backbone.residues) sorted.push_back(molecule.bFactors[b.trace]);
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> radii(molecule.residues.size(), kThinPutty);
  if (sorted.empty()) return radii;
  const auto percentile = [&](double p) {
    return static_cast<double>(sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))]);
  };
  const double low = percentile(0.05), high = percentile(0.95);
  for (const Backbone& backbone : backbones) {
    for (const BackboneResidue& b : backbone.residues) {
      const double value = static_cast<double>(molecule.bFactors[b.trace]);
      const double share = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.2;
      radii[b.residue] = kThinPutty + (kThickPutty - kThinPutty) * share;
    }
  }
  return radii;
}

}  // namespace

Ribbon makeRibbon(const Molecule& molecule, const std::vector<Backbone>& backbones,
                  const std::vector<bool>& chosen, RibbonStyle style, double size) {
  Ribbon ribbon;
  const std::vector<SecondaryStructure> secondary =
      style == RibbonStyle::cartoon ? secondaryOf(molecule, backbones) : std::vector<SecondaryStructure>();
  const std::vector<double> radii =
      style == RibbonStyle::putty ? puttyRadii(molecule, backbones) : std::vector<double>();
  for (const Backbone& backbone : backbones)
    Sweep(molecule, backbone, secondary, radii, style, size, ribbon).draw(chosen);
  return ribbon;
}

}  // namespace meniscus

#include "core/assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <map>
#include <string>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr double kLatticeGap = 4.0;                  // Å between the boxes of neighbouring copies
constexpr std::size_t kMaxPlacements = 100'000'000;  // 17 GB of placements; more is a typing error

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Box boxOf(const Molecule& molecule, const std::vector<Placement>& placements) {
  Box box;
  for (const Placement& placement : placements) {
    for (const IndexRange& range : placement.residues) {
      for (std::uint32_t r = range.first; r < range.end(); ++r) {
        const IndexRange& atoms = molecule.residues[r].atoms;
        for (std::uint32_t a = atoms.first; a < atoms.end(); ++a) {
          const glm::dvec3 p(placement.transform * glm::dvec4(molecule.positions[a], 1.0));
          box.low = glm::min(box.low, p);
          box.high = glm::max(box.high, p);
        }
      }
    }
  }
  return box;
}

std::string listIds(const Molecule& molecule) {
  std::string ids;
  for (const Assembly& assembly : molecule.assemblies) ids += (ids.empty() ? "" : ", ") + assembly.id;
  return ids;
}

}  // namespace

std::vector<Placement> placeOnce(const Molecule& molecule) {
  Placement placement;
  placement.residues.push_back({0, static_cast<std::uint32_t>(molecule.residues.size())});
  return {placement};
}

std::vector<Placement> placeAssembly(const Molecule& molecule, const std::string& id) {
  for (const Assembly& assembly : molecule.assemblies) {
    if (assembly.id != id) continue;
    std::vector<Placement> placements;
    for (const Assembly::Generator& generator : assembly.generators) {
      for (const glm::dmat4& operation : generator.operations) {
        placements.push_back({operation, generator.residues});
      }
    }
    return placements;
  }
  throw UsageError(
      molecule.assemblies.empty()
          ? fmt::format("{} describes no biological assemblies: leave out --assembly", molecule.name)
          : fmt::format("{} has no assembly '{}': choose one of {}", molecule.name, id, listIds(molecule)));
}

std::vector<Placement> replicate(const Molecule& molecule, const std::vector<Placement>& placements,
                                 glm::ivec3 n) {
  if (n.x < 1 || n.y < 1 || n.z < 1) throw UsageError("a lattice needs at least 1x1x1 copies");
  const double copies = static_cast<double>(n.x) * n.y * n.z;
  if (copies * static_cast<double>(placements.size()) > static_cast<double>(kMaxPlacements)) {
    throw UsageError(
        fmt::format("a lattice of {}x{}x{} is too large: at most {} copies", n.x, n.y, n.z, kMaxPlacements));
  }
  const Box box = boxOf(molecule, placements);
  const glm::dvec3 spacing = box.high - box.low + glm::dvec3(kLatticeGap);
  std::vector<Placement> lattice;
  lattice.reserve(static_cast<std::size_t>(copies) * placements.size());
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const glm::dvec3 cell = glm::dvec3(x, y, z) - 0.5 * (glm::dvec3(n) - 1.0);
        const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), cell * spacing);
        for (const Placement& placement : placements) {
          lattice.push_back({shift * placement.transform, placement.residues});
        }
      }
    }
  }
  return lattice;
}

std::vector<std::vector<std::uint32_t>> alikePlacements(const std::vector<Placement>& placements) {
  using Ranges = std::vector<IndexRange>;
  const auto before = [](const Ranges* a, const Ranges* b) {
    return std::lexicographical_compare(a->begin(), a->end(), b->begin(), b->end(),
                                        [](const IndexRange& x, const IndexRange& y) {
                                          return x.first != y.first ? x.first < y.first : x.count < y.count;
                                        });
  };
  std::map<const Ranges*, std::size_t, decltype(before)> known(before);
  std::vector<std::vector<std::uint32_t>> out;
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    const auto [place, isNew] = known.try_emplace(&placements[i].residues, out.size());
    if (isNew) out.emplace_back();
    out[place->second].push_back(i);
  }
  return out;
}

}  // namespace meniscus

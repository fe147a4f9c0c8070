#include "io/keep_atoms.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr std::uint32_t kGone = 0xFFFFFFFFu;

template <typename T>
void compact(std::vector<T>& values, const std::vector<std::uint8_t>& keep) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i]) values[kept++] = values[i];
  }
  values.resize(kept);
}

/// New ranges over the elements that stay, given for each old index the number of those that stay before it
/// (one entry more than elements).
IndexRange remap(const IndexRange& range, const std::vector<std::uint32_t>& before) {
  return {before[range.first], before[range.end()] - before[range.first]};
}

std::vector<std::uint32_t> countBefore(const std::vector<std::uint8_t>& keep) {
  std::vector<std::uint32_t> before(keep.size() + 1, 0);
  for (std::size_t i = 0; i < keep.size(); ++i) before[i + 1] = before[i] + (keep[i] ? 1u : 0u);
  return before;
}

void remapAssemblies(Molecule& m, const std::vector<std::uint32_t>& residuesBefore) {
  for (Assembly& assembly : m.assemblies) {
    for (Assembly::Generator& generator : assembly.generators) {
      for (IndexRange& range : generator.residues) range = remap(range, residuesBefore);
      std::erase_if(generator.residues, [](const IndexRange& range) { return range.count == 0; });
    }
    std::erase_if(assembly.generators, [](const Assembly::Generator& g) { return g.residues.empty(); });
  }
  std::erase_if(m.assemblies, [](const Assembly& assembly) { return assembly.generators.empty(); });
}

}  // namespace

void keepAtoms(Molecule& m, const std::vector<std::uint8_t>& keep) {
  MENISCUS_CHECK(keep.size() == m.atomCount());
  if (std::find(keep.begin(), keep.end(), std::uint8_t{0}) == keep.end()) return;
  const std::vector<std::uint32_t> atomsBefore = countBefore(keep);

  std::vector<std::uint8_t> keepResidue(m.residues.size());
  for (std::size_t i = 0; i < m.residues.size(); ++i) {
    m.residues[i].atoms = remap(m.residues[i].atoms, atomsBefore);
    keepResidue[i] = m.residues[i].atoms.count > 0;
  }
  const std::vector<std::uint32_t> residuesBefore = countBefore(keepResidue);
  std::vector<std::uint32_t> newChain(m.chains.size(), kGone);
  std::vector<Chain> chains;
  for (std::size_t i = 0; i < m.chains.size(); ++i) {
    m.chains[i].residues = remap(m.chains[i].residues, residuesBefore);
    if (m.chains[i].residues.count == 0) continue;
    newChain[i] = static_cast<std::uint32_t>(chains.size());
    chains.push_back(std::move(m.chains[i]));
  }
  m.chains = std::move(chains);
  std::vector<Residue> residues;
  residues.reserve(residuesBefore.back());
  for (std::size_t i = 0; i < m.residues.size(); ++i) {
    if (!keepResidue[i]) continue;
    residues.push_back(std::move(m.residues[i]));
    residues.back().chain = newChain[residues.back().chain];
  }
  m.residues = std::move(residues);
  remapAssemblies(m, residuesBefore);

  std::size_t kept = 0;
  for (const Bond& bond : m.bonds) {
    if (!keep[bond.a] || !keep[bond.b]) continue;
    m.bonds[kept] = bond;
    m.bonds[kept].a = atomsBefore[bond.a];
    m.bonds[kept++].b = atomsBefore[bond.b];
  }
  m.bonds.resize(kept);

  for (std::uint32_t& residue : m.residueOf) residue = residuesBefore[residue];
  compact(m.residueOf, keep);
  compact(m.positions, keep);
  compact(m.names, keep);
  compact(m.elements, keep);
  compact(m.bFactors, keep);
  compact(m.occupancies, keep);
  compact(m.altlocs, keep);
  compact(m.formalCharges, keep);
  compact(m.serials, keep);
  compact(m.anisotropies, keep);
}

}  // namespace meniscus

#include "io/molecule_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/elements.h"
#include "core/error.h"
#include "io/residue_kind.h"

namespace meniscus {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr double kFarthest = 1e7;               // Å; a micrometre is 1e4 Å
constexpr std::uint32_t kSearchedAtoms = 1000;  // a residue with more is a bag of atoms: names say nothing

template <typename T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::uint32_t i : order) sorted.push_back(values[i]);
  values = std::move(sorted);
}

}  // namespace

std::size_t MoleculeBuilder::KeyHash::operator()(const Key& key) const {
  std::size_t h = std::hash<std::string>()(key.name);
  for (const std::size_t part : {static_cast<std::size_t>(key.chain), static_cast<std::size_t>(key.number),
                                 static_cast<std::size_t>(key.insertionCode)}) {
    h = (h ^ part) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

void MoleculeBuilder::reserve(std::size_t atomCount) {
  residueOf_.reserve(atomCount);
  previousInResidue_.reserve(atomCount);
  positions_.reserve(atomCount);
  names_.reserve(atomCount);
  elements_.reserve(atomCount);
  bFactors_.reserve(atomCount);
  occupancies_.reserve(atomCount);
  altlocs_.reserve(atomCount);
  charges_.reserve(atomCount);
  serials_.reserve(atomCount);
}

void MoleculeBuilder::add(const AtomRecord& atom) {
  const glm::dvec3 p = atom.position;
  if (!(std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest)) {
    const std::string place = atom.line ? fmt::format("line {}: ", atom.line) : "";
    throw InputError(
        fmt::format("{}atom {} of {} {} has no usable position ({}, {}, {}): correct or remove it", place,
                    atom.name, atom.residueName, atom.residueNumber.value_or(0), p.x, p.y, p.z));
  }
  const auto index = static_cast<std::uint32_t>(positions_.size());
  if (index + 1 == kNone) throw InputError("holds more than 4,294,967,293 atoms: split it");
  const std::uint32_t residue = residueOf(atom);
  residueOf_.push_back(residue);
  previousInResidue_.push_back(lastInResidue_[residue]);
  lastInResidue_[residue] = index;
  ++residues_[residue].atomCount;
  positions_.push_back(p);
  names_.emplace_back(atom.name);
  elements_.push_back(atom.element);
  const bool sound = std::isfinite(atom.bFactor) && std::isfinite(atom.occupancy);
  if (!sound) oddities_.add("occupancy or B factor that is no number: taken as 1 and 0", atom.line);
  bFactors_.push_back(std::isfinite(atom.bFactor) ? atom.bFactor : 0.0f);
  occupancies_.push_back(std::isfinite(atom.occupancy) ? atom.occupancy : 1.0f);
  altlocs_.push_back(atom.altloc);
  charges_.push_back(atom.charge);
  serials_.push_back(atom.serial);
  if (!atom.anisotropy.isZero()) {
    anyAnisotropy_ = true;
    anisotropies_.resize(index);
    anisotropies_.push_back(atom.anisotropy);
  }
}

std::uint32_t MoleculeBuilder::chainOf(std::string_view name) {
  const auto [found, isNew] =
      chainByName_.try_emplace(std::string(name), static_cast<std::uint32_t>(chains_.size()));
  if (isNew) {
    chains_.emplace_back(name);
    lastNumber_.push_back(0);
  }
  return found->second;
}

/// Does a residue have an atom of this name and alternate location already?
bool MoleculeBuilder::holds(std::uint32_t residue, const AtomRecord& atom) const {
  if (residues_[residue].atomCount > kSearchedAtoms) return false;
  const AtomName name(atom.name);
  for (std::uint32_t i = lastInResidue_[residue]; i != kNone; i = previousInResidue_[i]) {
    if (names_[i] == name && altlocs_[i] == atom.altloc) return true;
  }
  return false;
}

std::uint32_t MoleculeBuilder::residueOf(const AtomRecord& atom) {
  if (current_ != kNone) {
    const PendingResidue& now = residues_[current_];
    const bool sameName = now.residue.name == atom.residueName && chains_[now.residue.chain] == atom.chain &&
                          now.residue.subchain == atom.subchain;
    if (sameName && atom.residueNumber) {
      if (currentIsNumbered_ && now.residue.number == *atom.residueNumber &&
          now.residue.insertionCode == atom.insertionCode) {
        return current_;
      }
    } else if (sameName && !currentIsNumbered_ && !holds(current_, atom)) {
      return current_;
    }
  }
  const std::uint32_t chain = chainOf(atom.chain);
  const bool numberable = lastNumber_[chain] < std::numeric_limits<std::int32_t>::max();
  const std::int32_t number =
      atom.residueNumber.value_or(numberable ? lastNumber_[chain] + 1 : lastNumber_[chain]);
  currentIsNumbered_ = atom.residueNumber.has_value();
  if (!currentIsNumbered_) oddities_.add("no residue number: numbered on from the residue before", atom.line);
  lastNumber_[chain] = number;
  Key key{chain, number, atom.insertionCode, std::string(atom.residueName)};
  const auto [found, isNew] =
      residueByKey_.try_emplace(std::move(key), static_cast<std::uint32_t>(residues_.size()));
  if (!isNew && !holds(found->second, atom)) {
    const Residue& left = residues_[current_].residue;
    if (left.chain != chain || left.number != number) {
      oddities_.add("residue taken up again after another one: its atoms were put together", atom.line);
    }
    return current_ = found->second;
  }
  if (!isNew) oddities_.add("residue number used again for another residue", atom.line);
  found->second = static_cast<std::uint32_t>(residues_.size());
  PendingResidue pending;
  pending.residue.name = atom.residueName;
  pending.residue.number = number;
  pending.residue.insertionCode = atom.insertionCode;
  pending.residue.hetero = atom.hetero;
  pending.residue.chain = chain;
  pending.residue.subchain = atom.subchain;
  pending.residue.entity = atom.entity;
  pending.residue.labelNumber = atom.labelNumber;
  residues_.push_back(std::move(pending));
  lastInResidue_.push_back(kNone);
  return current_ = found->second;
}

void MoleculeBuilder::reorderAtoms(const std::vector<std::uint32_t>& order) {
  permute(positions_, order);
  permute(names_, order);
  permute(elements_, order);
  permute(bFactors_, order);
  permute(occupancies_, order);
  permute(altlocs_, order);
  permute(charges_, order);
  permute(serials_, order);
  permute(residueOf_, order);
  if (anyAnisotropy_) permute(anisotropies_, order);
}

Molecule MoleculeBuilder::finish() {
  // Residues by chain, both in order of first appearance.
  std::vector<std::uint32_t> residueOrder(residues_.size());
  std::iota(residueOrder.begin(), residueOrder.end(), 0u);
  std::stable_sort(residueOrder.begin(), residueOrder.end(), [this](std::uint32_t a, std::uint32_t b) {
    return residues_[a].residue.chain < residues_[b].residue.chain;
  });
  Molecule m;
  for (const std::string& name : chains_) m.chains.push_back({name, {}});
  std::vector<std::uint32_t> nextOf(residues_.size());
  std::vector<std::uint32_t> rankOf(residues_.size());
  std::uint32_t first = 0;
  for (std::uint32_t rank = 0; rank < residueOrder.size(); ++rank) {
    PendingResidue& pending = residues_[residueOrder[rank]];
    pending.residue.atoms = {first, pending.atomCount};
    nextOf[residueOrder[rank]] = first;
    rankOf[residueOrder[rank]] = rank;
    first += pending.atomCount;
    IndexRange& range = m.chains[pending.residue.chain].residues;
    if (range.count++ == 0) range.first = rank;
    m.residues.push_back(std::move(pending.residue));
  }
  if (anyAnisotropy_) anisotropies_.resize(atomCount());
  std::vector<std::uint32_t> order(atomCount());
  bool inOrder = true;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t to = nextOf[residueOf_[i]]++;
    order[to] = i;
    inOrder &= to == i;
    residueOf_[i] = rankOf[residueOf_[i]];
  }
  if (!inOrder) reorderAtoms(order);
  m.positions = std::move(positions_);
  m.names = std::move(names_);
  m.elements = std::move(elements_);
  m.residueOf = std::move(residueOf_);
  m.bFactors = std::move(bFactors_);
  m.occupancies = std::move(occupancies_);
  m.altlocs = std::move(altlocs_);
  m.formalCharges = std::move(charges_);
  m.serials = std::move(serials_);
  m.anisotropies = std::move(anisotropies_);
  for (Residue& residue : m.residues) {
    residue.kind =
        residueKind(residue.name, std::span(m.names).subspan(residue.atoms.first, residue.atoms.count),
                    std::span(m.elements).subspan(residue.atoms.first, residue.atoms.count));
  }
  demoteFreeMonomers(m);
  return m;
}

}  // namespace meniscus

#pragma once
// From atoms in a file's order to a Molecule, in which residues and chains are contiguous.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/molecule.h"
#include "io/oddities.h"

namespace meniscus {

/// One atom as a file states it. Text is copied by MoleculeBuilder::add().
struct AtomRecord {
  std::string_view chain;                   ///< author chain id
  std::string_view subchain;                ///< label_asym_id; empty in PDB files
  std::string_view entity;                  ///< label_entity_id; empty in PDB files
  std::optional<std::int32_t> labelNumber;  ///< label_seq_id
  std::string_view residueName;
  std::optional<std::int32_t> residueNumber;  ///< nothing: the builder numbers on
  char insertionCode = ' ';
  bool hetero = false;
  std::string_view name;
  glm::dvec3 position{0};  ///< Å
  std::uint8_t element = 0;
  float bFactor = 0;
  float occupancy = 1;
  char altloc = ' ';
  std::int8_t charge = 0;
  std::int32_t serial = 0;
  Anisotropy anisotropy;
  std::size_t line = 0;  ///< for notes and errors; 0 = unknown
};

class MoleculeBuilder {
 public:
  explicit MoleculeBuilder(Oddities& oddities) : oddities_(oddities) {}

  void reserve(std::size_t atomCount);
  /// Throws InputError, without the file's name, if the position is not finite or beyond 1e7 Å.
  void add(const AtomRecord& atom);
  std::size_t atomCount() const { return positions_.size(); }
  Molecule finish();

 private:
  struct PendingResidue {
    Residue residue;
    std::uint32_t atomCount = 0;
  };
  struct Key {
    std::uint32_t chain;
    std::int32_t number;
    char insertionCode;
    std::string name;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  std::uint32_t chainOf(std::string_view name);
  std::uint32_t residueOf(const AtomRecord& atom);
  bool holds(std::uint32_t residue, const AtomRecord& atom) const;
  void reorderAtoms(const std::vector<std::uint32_t>& order);

  Oddities& oddities_;
  std::vector<PendingResidue> residues_;
  std::vector<std::string> chains_;
  std::unordered_map<std::string, std::uint32_t> chainByName_;
  std::unordered_map<Key, std::uint32_t, KeyHash> residueByKey_;
  std::vector<std::int32_t> lastNumber_;  ///< per chain, for residues without a number
  std::uint32_t current_ = 0xFFFFFFFFu;
  bool currentIsNumbered_ = true;

  // In the file's order:
  std::vector<std::uint32_t> residueOf_;
  std::vector<std::uint32_t> previousInResidue_;  ///< atom before this one in its residue, or none
  std::vector<std::uint32_t> lastInResidue_;      ///< per residue
  std::vector<glm::dvec3> positions_;
  std::vector<AtomName> names_;
  std::vector<std::uint8_t> elements_;
  std::vector<float> bFactors_, occupancies_;
  std::vector<char> altlocs_;
  std::vector<std::int8_t> charges_;
  std::vector<std::int32_t> serials_;
  std::vector<Anisotropy> anisotropies_;
  bool anyAnisotropy_ = false;
};

}  // namespace meniscus

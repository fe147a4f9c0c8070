#pragma once
// What a structure file says, as plain arrays: no colours, no files, no GL. Lengths in Å.

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// Half-open range [first, first + count) into one of the arrays below.
struct IndexRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t end() const { return first + count; }
  bool operator==(const IndexRange&) const = default;
};

/// Atom name as in the file, without blanks ("CA", "O5'"); longer names are cut to 7 characters.
struct AtomName {
  std::array<char, 8> text{};  ///< zero-terminated

  AtomName() = default;
  explicit AtomName(std::string_view name) {
    for (std::size_t i = 0; i < name.size() && i + 1 < text.size(); ++i) text[i] = name[i];
  }
  std::string_view view() const { return text.data(); }
  bool operator==(const AtomName&) const = default;
};

/// Anisotropic displacement tensor U [Å^2], symmetric.
struct Anisotropy {
  float u11 = 0, u22 = 0, u33 = 0, u12 = 0, u13 = 0, u23 = 0;
  bool isZero() const { return u11 == 0 && u22 == 0 && u33 == 0 && u12 == 0 && u13 == 0 && u23 == 0; }
};

enum class ResidueKind : std::uint8_t { aminoAcid, nucleotide, water, ion, ligand, saccharide };

/// Where a residue's backbone runs; turns and bends count as coil.
enum class SecondaryStructure : std::uint8_t { coil, helix, strand };

struct Residue {
  std::string name;          ///< "ALA", "DG", "HEM"
  std::int32_t number = 0;   ///< author numbering, may be negative
  char insertionCode = ' ';  ///< ' ' if none
  ResidueKind kind = ResidueKind::ligand;
  bool hetero = false;  ///< HETATM rather than ATOM
  std::uint32_t chain = 0;
  IndexRange atoms;
  std::string subchain;                     ///< label_asym_id; empty in PDB files
  std::string entity;                       ///< label_entity_id; empty in PDB files
  std::optional<std::int32_t> labelNumber;  ///< label_seq_id; nothing in PDB files and outside polymers
  SecondaryStructure secondary = SecondaryStructure::coil;  ///< as the file says, see hasSecondary
};

/// Whether two residues are alternatives of one place in their chain (microheterogeneity).
inline bool samePlace(const Residue& a, const Residue& b) {
  return a.chain == b.chain && a.number == b.number && a.insertionCode == b.insertionCode;
}

struct Chain {
  std::string name;  ///< author chain id (auth_asym_id); may be empty (blank) or many letters
  IndexRange residues;
};

/// Where the knowledge of a bond came from, in order of trust.
enum class BondOrigin : std::uint8_t { connection, conect, residueTemplate, distance };

struct Bond {
  std::uint32_t a = 0, b = 0;  ///< atom indices, a < b
  std::uint8_t order = 1;      ///< 1, 2, 3; 4 = aromatic
  BondOrigin origin = BondOrigin::distance;
};

/// Biological assembly: every operator of a generator is applied to the generator's residues.
struct Assembly {
  struct Generator {
    std::vector<IndexRange> residues;    ///< ranges into Molecule::residues, ascending, disjoint
    std::vector<glm::dmat4> operations;  ///< rigid motions, column-major, Å
  };
  std::string id;
  std::vector<Generator> generators;
};

struct UnitCell {
  double a = 0, b = 0, c = 0;                ///< Å
  double alpha = 90, beta = 90, gamma = 90;  ///< degrees
};

/// One model of a structure. All per-atom arrays have atomCount() entries, except anisotropies, which is
/// empty when the file has none. Atoms of a residue, and residues of a chain, are contiguous.
struct Molecule {
  std::string name;                   ///< entry id or file stem
  std::int32_t model = 1;             ///< model number in the file
  std::int32_t modelIndex = 0;        ///< position among the file's models, from 0
  std::vector<glm::dvec3> positions;  ///< Å
  std::vector<AtomName> names;
  std::vector<std::uint8_t> elements;    ///< atomic number, 0 = unknown; deuterium is 1
  std::vector<std::uint32_t> residueOf;  ///< index into residues
  std::vector<float> bFactors;           ///< Å^2, or pLDDT in predicted models
  std::vector<float> occupancies;
  std::vector<char> altlocs;  ///< ' ' if none
  std::vector<std::int8_t> formalCharges;
  std::vector<std::int32_t> serials;
  std::vector<Anisotropy> anisotropies;  ///< empty, or one per atom (all zero where the file has none)
  std::vector<Residue> residues;
  std::vector<Chain> chains;
  std::vector<Bond> bonds;  ///< those of the file's records after reading; all after addMissingBonds()
  std::vector<Assembly> assemblies;
  std::optional<UnitCell> cell;
  std::string spaceGroup;     ///< Hermann-Mauguin symbol as in the file ("P 21 21 21"); may be empty
  bool hasSecondary = false;  ///< the file describes helices or strands
  bool predicted = false;     ///< a computed model whose B column holds pLDDT (0..100)

  std::size_t atomCount() const { return positions.size(); }
  std::uint32_t chainOf(std::size_t atom) const { return residues[residueOf[atom]].chain; }
};

}  // namespace meniscus

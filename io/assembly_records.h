#pragma once
// Biological assemblies as files state them: lists of chains and of operators, combined by expressions.

#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/molecule.h"
#include "io/oddities.h"

namespace meniscus {

struct AssemblyRecord {
  struct Generator {
    std::vector<std::string> chains;     ///< author ids (PDB) or label_asym_ids (mmCIF)
    std::vector<glm::dmat4> operations;  ///< Å
  };
  std::string id;
  std::vector<Generator> generators;
};

/// The operators of an mmCIF expression: "1", "P", "1,2,5", "(1-60)", "(X0)(1-60)(61-88)"; of a product the
/// rightmost acts first. Nothing if it is malformed, names an unknown operator, or yields more than a
/// million.
std::optional<std::vector<glm::dmat4>> expandOperations(const std::string& expression,
                                                        const std::map<std::string, glm::dmat4>& operators);

/// What the records call a chain: Chain::name, or Residue::subchain.
enum class ChainNaming : std::uint8_t { chain, subchain };

/// Turns chain lists into ranges of residues. Unknown chains become oddities; assemblies that come out empty
/// are left out.
void addAssemblies(Molecule& molecule, const std::vector<AssemblyRecord>& records, ChainNaming naming,
                   Oddities& oddities);

}  // namespace meniscus

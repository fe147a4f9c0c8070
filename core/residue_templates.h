#pragma once
// Which atoms are bonded within the standard amino acids and nucleotides.

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

struct TemplateBond {
  std::uint8_t a = 0, b = 0;  ///< indices into ResidueTemplate::names
  std::uint8_t order = 1;     ///< 1, 2, or 4 = aromatic
};

struct ResidueTemplate {
  ResidueKind kind = ResidueKind::aminoAcid;  ///< or nucleotide
  std::vector<AtomName> names;                ///< at most 255
  std::vector<TemplateBond> bonds;

  /// Index of an atom name, also in its remediated form (O5* as O5'); -1 if the residue has none such.
  int indexOf(const AtomName& name) const;
};

/// The template of a residue name, protonation variants included (HID, CYX, ASH, ...); null if there is none.
const ResidueTemplate* findResidueTemplate(std::string_view residueName);

}  // namespace meniscus

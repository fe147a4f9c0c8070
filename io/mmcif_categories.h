#pragma once
// What mmCIF says besides the atoms. Takes gemmi's document, so it is for readers in this folder only.

#include <gemmi/cifdoc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/molecule.h"
#include "io/assembly_records.h"
#include "io/connections.h"
#include "io/oddities.h"
#include "io/secondary_records.h"

namespace meniscus {

/// _struct_conn without hydrogen bonds, salt bridges and bonds to symmetry mates. Addresses use label ids if
/// `labelIds`.
std::vector<NamedBond> readConnections(gemmi::cif::Block& block, bool labelIds);

/// _pdbx_struct_assembly_gen with its operators; chains are label_asym_ids.
std::vector<AssemblyRecord> readAssemblies(gemmi::cif::Block& block, Oddities& oddities);

/// Helices and strands of _struct_conf and _struct_sheet_range. Addresses use label ids if `labelIds`.
std::vector<SecondaryRange> readSecondary(gemmi::cif::Block& block, bool labelIds);

/// _cell, if it is a real one.
std::optional<UnitCell> readCell(gemmi::cif::Block& block);

/// Hermann-Mauguin symbol; empty if none is given.
std::string readSpaceGroup(gemmi::cif::Block& block);

/// Is it a computed model by its categories, its id or its software?
bool saysPredicted(gemmi::cif::Block& block);

/// sing, doub, trip, arom, delo in any case and length; 1 for anything else.
std::uint8_t bondOrder(std::string_view word);

}  // namespace meniscus

#pragma once
// The element of an atom whose file does not say it.

#include <cstdint>
#include <string_view>

namespace meniscus {

/// From a PDB atom name field of four columns (13-16), where the element's symbol should end in the second
/// column: " CA " is a carbon, "CA  " calcium; within standard residues, and for hydrogens of four letters,
/// the name decides alone, since many programs do not align it. 0 if nothing fits.
std::uint8_t guessElement(std::string_view field, std::string_view residueName);

}  // namespace meniscus

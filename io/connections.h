#pragma once
// Bonds that a file states: by the names of their atoms (LINK, SSBOND, _struct_conn) or by serial numbers
// (CONECT).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/molecule.h"
#include "io/oddities.h"

namespace meniscus {

struct AtomAddress {
  std::string chain;
  std::optional<std::int32_t> residueNumber;
  char insertionCode = ' ';
  std::string residueName;
  std::string atom;
  char altloc = ' ';  ///< ' ' = any
};

struct NamedBond {
  AtomAddress a, b;
  std::uint8_t order = 1;
};

struct SerialBond {
  std::int32_t a = 0, b = 0;
  std::uint8_t order = 1;
};

/// Adds bonds of origin `connection`. Addresses that name no atom, and atoms over 6 Å apart (mates in the
/// crystal), become oddities.
void addNamedBonds(Molecule& molecule, const std::vector<NamedBond>& bonds, Oddities& oddities);

/// Adds bonds of origin `conect`. Where a serial number occurs several times, the closest pair is meant.
void addSerialBonds(Molecule& molecule, const std::vector<SerialBond>& bonds, Oddities& oddities);

}  // namespace meniscus

#include "io/connections.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace meniscus {
namespace {

constexpr double kLongestNamed =
    6.0;  // Å; beyond, the partner is a symmetry mate that the file does not hold
constexpr double kLongestAmbiguous = 4.0;  // Å; serial numbers that occur twice are trusted only this far
constexpr std::size_t kMaxSameSerial = 64;

class AddressBook {
 public:
  explicit AddressBook(const Molecule& molecule) : m_(molecule) {
    for (std::uint32_t i = 0; i < m_.residues.size(); ++i) {
      const Residue& residue = m_.residues[i];
      places_[{m_.chains[residue.chain].name, residue.number, residue.insertionCode}].push_back(i);
    }
  }

  std::vector<std::uint32_t> atomsAt(const AtomAddress& address) const {
    std::vector<std::uint32_t> atoms;
    const auto place =
        places_.find({address.chain, address.residueNumber.value_or(0), address.insertionCode});
    if (place == places_.end()) return atoms;
    const AtomName name(address.atom);
    for (const std::uint32_t r : place->second) {
      const Residue& residue = m_.residues[r];
      if (!address.residueName.empty() && residue.name != address.residueName) continue;
      for (std::uint32_t i = residue.atoms.first; i < residue.atoms.end(); ++i) {
        const bool altlocFits =
            address.altloc == ' ' || m_.altlocs[i] == ' ' || m_.altlocs[i] == address.altloc;
        if (m_.names[i] == name && altlocFits) atoms.push_back(i);
      }
    }
    return atoms;
  }

 private:
  const Molecule& m_;
  std::map<std::tuple<std::string, std::int32_t, char>, std::vector<std::uint32_t>> places_;
};

bool altlocsMeet(char a, char b) {
  return a == b || a == ' ' || b == ' ';
}

Bond makeBond(std::uint32_t a, std::uint32_t b, std::uint8_t order, BondOrigin origin) {
  return {std::min(a, b), std::max(a, b), order, origin};
}

}  // namespace

void addNamedBonds(Molecule& molecule, const std::vector<NamedBond>& bonds, Oddities& oddities) {
  if (bonds.empty()) return;
  const AddressBook book(molecule);
  for (const NamedBond& bond : bonds) {
    const std::vector<std::uint32_t> from = book.atomsAt(bond.a);
    const std::vector<std::uint32_t> to = book.atomsAt(bond.b);
    if (from.empty() || to.empty()) {
      oddities.add("a connection record names an atom that is not there: left out", 0);
      continue;
    }
    for (const std::uint32_t a : from) {
      for (const std::uint32_t b : to) {
        if (a == b || !altlocsMeet(molecule.altlocs[a], molecule.altlocs[b])) continue;
        if (glm::distance(molecule.positions[a], molecule.positions[b]) > kLongestNamed) {
          oddities.add("a connection record joins atoms over 6 Å apart (a symmetry mate?): left out", 0);
        } else {
          molecule.bonds.push_back(makeBond(a, b, bond.order, BondOrigin::connection));
        }
      }
    }
  }
}

void addSerialBonds(Molecule& molecule, const std::vector<SerialBond>& bonds, Oddities& oddities) {
  if (bonds.empty()) return;
  std::unordered_map<std::int32_t, std::vector<std::uint32_t>> atomsOf;
  for (const SerialBond& bond : bonds) {
    atomsOf[bond.a];
    atomsOf[bond.b];
  }
  for (std::uint32_t i = 0; i < molecule.atomCount(); ++i) {
    const auto found = atomsOf.find(molecule.serials[i]);
    if (found != atomsOf.end() && found->second.size() < kMaxSameSerial) found->second.push_back(i);
  }
  for (const SerialBond& bond : bonds) {
    const std::vector<std::uint32_t>& from = atomsOf[bond.a];
    const std::vector<std::uint32_t>& to = atomsOf[bond.b];
    const bool ambiguous = from.size() > 1 || to.size() > 1;
    double closest = ambiguous ? kLongestAmbiguous : 1e30;
    std::pair<std::uint32_t, std::uint32_t> pair{0, 0};
    for (const std::uint32_t a : from) {
      for (const std::uint32_t b : to) {
        const double d = glm::distance(molecule.positions[a], molecule.positions[b]);
        if (a != b && d < closest) {
          closest = d;
          pair = {a, b};
        }
      }
    }
    if (pair.first != pair.second) {
      molecule.bonds.push_back(makeBond(pair.first, pair.second, bond.order, BondOrigin::conect));
    } else {
      oddities.add(
          ambiguous
              ? "a CONECT record has serial numbers that occur several times, none of them near: left out"
              : "a CONECT record names a serial number that is not there: left out",
          0);
    }
  }
}

}  // namespace meniscus

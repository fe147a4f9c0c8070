// CID selections: the syntax is gemmi's (gemmi.readthedocs.io, "Selections"), evaluated on our arrays.
#include <fmt/format.h>

#include <climits>
#include <exception>
#define USE_STD_SNPRINTF  // select.hpp asks for stb_sprintf otherwise, which is not needed to evaluate
                          // selections
#include <gemmi/select.hpp>

#include "core/error.h"
#include "io/structure_reader.h"

namespace meniscus {
namespace {

gemmi::Selection parse(const std::string& cid) {
  try {
    gemmi::Selection selection(cid);
    // "48" is that residue alone, as in MMDB; gemmi 0.5 takes it for "48-", all from there on. Where there is
    // a dash it reads an end, without an insertion code if that is open.
    const bool starts = selection.from_seqid.seqnum != INT_MIN;
    const bool ends = selection.to_seqid.seqnum != INT_MAX || selection.to_seqid.icode != '*' ||
                      cid.find("-*") != std::string::npos;
    if (starts && !ends) selection.to_seqid = selection.from_seqid;
    return selection;
  } catch (const std::exception&) {
    throw UsageError(fmt::format(
        "'{}' is no selection: write it as /model/chains/residues/atoms, for example //A/10-20/CA[C]", cid));
  }
}

gemmi::EntityType entityTypeOf(ResidueKind kind) {
  switch (kind) {
    case ResidueKind::aminoAcid:
    case ResidueKind::nucleotide:
      return gemmi::EntityType::Polymer;
    case ResidueKind::water:
      return gemmi::EntityType::Water;
    default:
      return gemmi::EntityType::NonPolymer;
  }
}

}  // namespace

std::vector<std::uint32_t> selectAtoms(const Molecule& m, const std::string& cid) {
  const gemmi::Selection selection = parse(cid);
  std::vector<std::uint32_t> selected;
  if (selection.mdl != 0 && selection.mdl != m.model) return selected;
  gemmi::Residue residue;
  gemmi::Atom atom;
  for (const Chain& chain : m.chains) {
    if (!selection.chain_ids.has(chain.name)) continue;
    for (std::uint32_t r = chain.residues.first; r < chain.residues.end(); ++r) {
      const Residue& from = m.residues[r];
      residue.name = from.name;
      residue.seqid = gemmi::SeqId(from.number, from.insertionCode);
      residue.entity_type = entityTypeOf(from.kind);
      if (!selection.matches(residue)) continue;
      for (std::uint32_t i = from.atoms.first; i < from.atoms.end(); ++i) {
        atom.name = m.names[i].view();
        atom.altloc = m.altlocs[i] == ' ' ? '\0' : m.altlocs[i];
        atom.element = gemmi::Element(static_cast<int>(m.elements[i]));
        atom.b_iso = m.bFactors[i];
        atom.occ = m.occupancies[i];
        if (selection.matches(atom)) selected.push_back(i);
      }
    }
  }
  return selected;
}

}  // namespace meniscus

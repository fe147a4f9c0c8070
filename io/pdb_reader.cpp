// PDB files through gemmi: the text is mended first (pdb_text.h), model by model, and parsed once.
#include <fmt/format.h>

#include <gemmi/pdb.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/assembly_records.h"
#include "io/connections.h"
#include "io/format_readers.h"
#include "io/pdb_text.h"
#include "io/secondary_records.h"

namespace meniscus {
namespace {

struct AtomPlace {
  const gemmi::Chain* chain = nullptr;
  const gemmi::Residue* residue = nullptr;
  const gemmi::Atom* atom = nullptr;
};

/// gemmi's atoms in the order of the file, which their serial numbers hold.
std::vector<AtomPlace> inFileOrder(const gemmi::Model& model, std::size_t atomCount) {
  std::vector<AtomPlace> places(atomCount);
  for (const gemmi::Chain& chain : model.chains) {
    for (const gemmi::Residue& residue : chain.residues) {
      for (const gemmi::Atom& atom : residue.atoms) {
        MENISCUS_CHECK(atom.serial >= 0 && static_cast<std::size_t>(atom.serial) < atomCount);
        places[static_cast<std::size_t>(atom.serial)] = {&chain, &residue, &atom};
      }
    }
  }
  return places;
}

Anisotropy toAnisotropy(const gemmi::SMat33<float>& u) {
  return {u.u11, u.u22, u.u33, u.u12, u.u13, u.u23};
}

Molecule buildModel(const gemmi::Structure& structure, const MendedPdb& mended, Oddities& oddities) {
  MoleculeBuilder builder(oddities);
  builder.reserve(mended.atoms.size());
  const std::vector<AtomPlace> places = inFileOrder(structure.models.at(0), mended.atoms.size());
  std::string longName;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [chain, residue, atom] = places[i];
    MENISCUS_CHECK(atom != nullptr);
    const PdbAtomLine& line = mended.atoms[i];
    AtomRecord record;
    record.chain = chain->name;
    record.residueName = residue->name;
    if (line.fourthLetter != ' ') {
      longName = residue->name + line.fourthLetter;
      record.residueName = longName;
    }
    if (residue->seqid.num.has_value()) record.residueNumber = *residue->seqid.num;
    record.insertionCode = residue->seqid.icode;
    record.hetero = residue->het_flag == 'H';
    record.name = atom->name;
    record.position = {atom->pos.x, atom->pos.y, atom->pos.z};
    record.element = static_cast<std::uint8_t>(atom->element.atomic_number());
    record.bFactor = atom->b_iso;
    record.occupancy = atom->occ;
    record.altloc = atom->altloc == '\0' ? ' ' : atom->altloc;
    record.charge = atom->charge;
    record.serial = line.serial;
    record.anisotropy = toAnisotropy(atom->aniso);
    record.line = line.line;
    builder.add(record);
  }
  return builder.finish();
}

AtomAddress toAddress(const gemmi::AtomAddress& from) {
  AtomAddress address;
  address.chain = from.chain_name;
  if (from.res_id.seqid.num.has_value()) address.residueNumber = *from.res_id.seqid.num;
  address.insertionCode = from.res_id.seqid.icode;
  address.residueName = from.res_id.name;
  address.atom = from.atom_name;
  address.altloc = from.altloc == '\0' ? ' ' : from.altloc;
  return address;
}

std::vector<NamedBond> toBonds(const gemmi::Structure& structure) {
  std::vector<NamedBond> bonds;
  for (const gemmi::Connection& connection : structure.connections) {
    if (connection.asu == gemmi::Asu::Different) continue;
    bonds.push_back({toAddress(connection.partner1), toAddress(connection.partner2), 1});
  }
  return bonds;
}

glm::dmat4 toMatrix(const gemmi::Transform& t) {
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = t.mat[row][column];
    matrix[3][row] = t.vec.at(row);
  }
  return matrix;
}

std::vector<AssemblyRecord> toAssemblies(const gemmi::Structure& structure) {
  std::vector<AssemblyRecord> records;
  for (const gemmi::Assembly& assembly : structure.assemblies) {
    AssemblyRecord record;
    record.id = assembly.name;
    for (const gemmi::Assembly::Gen& generator : assembly.generators) {
      AssemblyRecord::Generator to;
      to.chains = generator.chains;
      for (const gemmi::Assembly::Operator& op : generator.operators)
        to.operations.push_back(toMatrix(op.transform));
      record.generators.push_back(std::move(to));
    }
    records.push_back(std::move(record));
  }
  return records;
}

/// A cell of 1 x 1 x 1 Å is the way of saying that there is none.
std::optional<UnitCell> toCell(const gemmi::UnitCell& cell) {
  if (!(cell.a > 1 && cell.b > 1 && cell.c > 1)) return std::nullopt;
  return UnitCell{cell.a, cell.b, cell.c, cell.alpha, cell.beta, cell.gamma};
}

std::vector<SecondaryRange> toSecondary(const gemmi::Structure& structure) {
  std::vector<SecondaryRange> ranges;
  const auto add = [&](SecondaryStructure kind, const gemmi::AtomAddress& first,
                       const gemmi::AtomAddress& last) {
    const gemmi::SeqId& a = first.res_id.seqid;
    const gemmi::SeqId& b = last.res_id.seqid;
    if (!a.num.has_value() || !b.num.has_value()) return;
    ranges.push_back({kind, first.chain_name, last.chain_name, *a.num, *b.num, a.icode, b.icode});
  };
  for (const gemmi::Helix& helix : structure.helices) add(SecondaryStructure::helix, helix.start, helix.end);
  for (const gemmi::Sheet& sheet : structure.sheets)
    for (const gemmi::Sheet::Strand& strand : sheet.strands)
      add(SecondaryStructure::strand, strand.start, strand.end);
  return ranges;
}

std::vector<int> modelNumbers(const PdbOutline& outline) {
  std::vector<int> numbers;
  int next = 1;
  for (const PdbModelSpan& model : outline.models) {
    numbers.push_back(model.number.value_or(next));
    next = numbers.back() < 1'000'000'000 ? numbers.back() + 1 : 1;
  }
  return numbers;
}

}  // namespace

ReadModels readPdb(const std::string& text, const ModelChoice& choice, Oddities& oddities) {
  const PdbOutline outline = outlinePdb(text, oddities);
  if (outline.models.empty()) throw InputError("has no ATOM or HETATM records: is it a structure?");
  std::vector<int> numbers = modelNumbers(outline);
  ReadModels read;
  read.modelCount = static_cast<int>(numbers.size());
  std::vector<NamedBond> named;
  std::vector<AssemblyRecord> assemblies;
  std::optional<UnitCell> cell;
  std::vector<SecondaryRange> secondary;
  bool first = true;
  for (const std::size_t i : chooseModels(numbers, choice, oddities)) {
    MendedPdb mended = mendPdbModel(text, outline.models[i], oddities);
    if (first) mended.text.insert(0, outline.header);
    const gemmi::Structure structure =
        gemmi::read_pdb_from_memory(mended.text.data(), mended.text.size(), "");
    if (first) {
      named = toBonds(structure);
      assemblies = toAssemblies(structure);
      cell = toCell(structure.cell);
      secondary = toSecondary(structure);
    }
    first = false;
    Molecule molecule = buildModel(structure, mended, oddities);
    molecule.name = outline.entryId;
    molecule.model = numbers[i];
    molecule.modelIndex = static_cast<std::int32_t>(i);
    molecule.cell = cell;
    molecule.spaceGroup = outline.spaceGroup;
    addSecondary(molecule, secondary, oddities);
    addNamedBonds(molecule, named, oddities);
    addSerialBonds(molecule, outline.conect, oddities);
    addAssemblies(molecule, assemblies, ChainNaming::chain, oddities);
    if (outline.saysPredicted && !outline.saysExperiment) markPredicted(molecule, oddities);
    read.models.push_back(std::move(molecule));
  }
  return read;
}

}  // namespace meniscus

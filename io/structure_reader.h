#pragma once
// PDB and mmCIF files, plain or gzipped, and BinaryCIF, of every era and habit, as Molecules (through gemmi,
// which does not leave this folder).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/logger.h"
#include "core/molecule.h"

namespace meniscus {

enum class Altlocs : std::uint8_t {
  first,  ///< per residue, the first location (by letter) is kept, with all blank ones
  all,
  named  ///< blank ones and those with StructureOptions::altloc
};

enum class Waters : std::uint8_t { on, off, automatic };  ///< automatic: off unless nothing else is there

struct StructureOptions {
  std::optional<int> model;       ///< model number; nothing = the first model
  std::optional<int> modelIndex;  ///< position of the model in the file, from 0; before `model`
  bool allModels = false;         ///< read every model
  Altlocs altlocs = Altlocs::all;
  char altloc = 'A';  ///< for Altlocs::named
  bool hydrogens = true;
  Waters waters = Waters::on;
  std::string select;  ///< gemmi CID selection ("//A/10-20/CA[C]"); empty = everything
  bool operator==(const StructureOptions&) const = default;
};

enum class StructureFormat : std::uint8_t { pdb, mmcif, binaryCif };

struct StructureFile {
  StructureFormat format = StructureFormat::mmcif;
  std::vector<Molecule> models;  ///< the chosen ones, in file order; never empty, each with at least one atom
  int modelCount = 0;            ///< how many the file has
};

/// Reads a structure. Oddities that could be mended are noted; throws InputError (file, place, remedy) if
/// the file is missing, unreadable, truncated, no structure, or if nothing is left after the options;
/// UsageError if the model number or the selection's syntax is not valid.
StructureFile readStructure(const std::filesystem::path& path, const StructureOptions& options,
                            Logger& logger);

/// The same of a file's bytes, plain or gzipped; `name` stands for the file.
StructureFile readStructureBytes(std::string bytes, const std::filesystem::path& name,
                                 const StructureOptions& options, Logger& logger);

/// Atoms of a molecule that a gemmi CID selection matches, ascending. Throws UsageError on bad syntax.
std::vector<std::uint32_t> selectAtoms(const Molecule& molecule, const std::string& cid);

}  // namespace meniscus

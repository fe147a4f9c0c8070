#include "io/structure_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "io/binary_cif.h"
#include "io/file_bytes.h"
#include "io/format_readers.h"
#include "io/keep_atoms.h"
#include "io/oddities.h"
#include "io/structure_kind.h"

namespace meniscus {
namespace {

/// File name without folder, ".gz" and the extension.
std::string stemOf(std::filesystem::path path) {
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

std::string extensionOf(std::filesystem::path path) {
  if (path.extension() == ".gz") path = path.stem();
  return lowerCase(path.extension().string());
}

/// Takes off a byte order mark and turns lone carriage returns (classic Mac OS) into line feeds.
void mendLineEnds(std::string& text, Oddities& oddities) {
  if (std::string_view(text).substr(0, 3) == "\xEF\xBB\xBF") {
    oddities.add("byte order mark at the start of the file", 0);
    text.erase(0, 3);
  }
  bool lone = false;
  bool pairs = false;
  for (std::size_t at = text.find('\r'); at != std::string::npos; at = text.find('\r', at + 1)) {
    if (at + 1 < text.size() && text[at + 1] == '\n') {
      pairs = true;
    } else {
      lone = true;
      text[at] = '\n';
    }
  }
  if (pairs) oddities.add("lines end with CR LF", 0);
  if (lone) oddities.add("lines end with CR", 0);
}

/// Atoms of residues at one place share its first alternate location, so that of two residue names one stays.
void markFirstAltlocs(const Molecule& m, std::vector<std::uint8_t>& keep) {
  for (std::size_t first = 0; first < m.residues.size();) {
    std::size_t end = first + 1;
    while (end < m.residues.size() && samePlace(m.residues[first], m.residues[end])) ++end;
    const std::uint32_t begin = m.residues[first].atoms.first;
    const std::uint32_t last = m.residues[end - 1].atoms.end();
    char lowest = ' ';
    for (std::uint32_t i = begin; i < last; ++i) {
      if (m.altlocs[i] != ' ' && (lowest == ' ' || m.altlocs[i] < lowest)) lowest = m.altlocs[i];
    }
    for (std::uint32_t i = begin; i < last; ++i) {
      if (m.altlocs[i] != ' ' && m.altlocs[i] != lowest) keep[i] = 0;
    }
    first = end;
  }
}

void markWaters(const Molecule& m, Waters waters, std::vector<std::uint8_t>& keep) {
  if (waters == Waters::on) return;
  const auto isWater = [](const Residue& residue) { return residue.kind == ResidueKind::water; };
  if (waters == Waters::automatic && std::all_of(m.residues.begin(), m.residues.end(), isWater)) return;
  for (std::size_t i = 0; i < m.atomCount(); ++i) {
    if (isWater(m.residues[m.residueOf[i]])) keep[i] = 0;
  }
}

void applyOptions(Molecule& m, const StructureOptions& options) {
  std::vector<std::uint8_t> keep(m.atomCount(), 1);
  if (options.altlocs == Altlocs::first) markFirstAltlocs(m, keep);
  for (std::size_t i = 0; i < m.atomCount(); ++i) {
    if (options.altlocs == Altlocs::named && m.altlocs[i] != ' ' && m.altlocs[i] != options.altloc)
      keep[i] = 0;
    if (!options.hydrogens && m.elements[i] == 1) keep[i] = 0;
  }
  markWaters(m, options.waters, keep);
  if (!options.select.empty()) {
    std::vector<std::uint8_t> selected(m.atomCount(), 0);
    for (const std::uint32_t i : selectAtoms(m, options.select)) selected[i] = 1;
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] &= selected[i];
  }
  keepAtoms(m, keep);
}

/// Sets `format` once it is known.
ReadModels readModels(std::string bytes, const std::filesystem::path& path, const StructureOptions& options,
                      Oddities& oddities, StructureFormat& format) {
  const bool binary = isBinaryCif(bytes);
  std::string text = binary ? std::string() : textOf(std::move(bytes), path);
  const ModelChoice choice{options.model, options.allModels, options.modelIndex};
  try {
    if (binary) text = textFromBinaryCif(bytes);
    mendLineEnds(text, oddities);
    const bool pdb = detectKind(text, extensionOf(path)) == StructureKind::pdb;
    format = pdb ? StructureFormat::pdb : binary ? StructureFormat::binaryCif : StructureFormat::mmcif;
    return pdb ? readPdb(text, choice, oddities) : readMmcif(text, choice, oddities);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", path.string(), error.what()));
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: there is not enough memory to read it: split it", path.string()));
  } catch (const std::exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(
        fmt::format("{}: cannot be read ({}): correct it or fetch it again", path.string(), what));
  }
}

}  // namespace

StructureFile readStructure(const std::filesystem::path& path, const StructureOptions& options,
                            Logger& logger) {
  return readStructureBytes(readBytes(path), path, options, logger);
}

StructureFile readStructureBytes(std::string bytes, const std::filesystem::path& path,
                                 const StructureOptions& options, Logger& logger) {
  Oddities oddities;
  StructureFile file;
  ReadModels read = readModels(std::move(bytes), path, options, oddities, file.format);
  file.modelCount = read.modelCount;
  for (Molecule& molecule : read.models) {
    if (molecule.name.empty()) molecule.name = stemOf(path);
    applyOptions(molecule, options);
    if (molecule.atomCount() > 0) file.models.push_back(std::move(molecule));
  }
  oddities.report(logger);
  if (file.models.empty()) {
    throw InputError(fmt::format(
        "{}: no atom is left by the options: check --select, --altloc, hydrogens and waters", path.string()));
  }
  return file;
}

}  // namespace meniscus

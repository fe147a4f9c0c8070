// `meniscus info`: what a structure file holds, as a table or as JSON.

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/run_report.h"
#include "core/bonds.h"
#include "core/error.h"
#include "core/structure_counts.h"
#include "io/structure_reader.h"

namespace meniscus {
namespace {

constexpr const char* kInfoDescription =
    "Says what a structure file (PDB, mmCIF, plain or .gz, BinaryCIF) holds.\n";

constexpr const char* kInfoExamples =
    "  meniscus info 1crn.pdb\n"
    "  meniscus info 4hhb.cif.gz --json\n"
    "  meniscus info 4hhb.cif.gz --json | jq .assemblies\n";

constexpr std::pair<BondOrigin, const char*> kOrigins[] = {{BondOrigin::connection, "connection"},
                                                           {BondOrigin::conect, "conect"},
                                                           {BondOrigin::residueTemplate, "template"},
                                                           {BondOrigin::distance, "distance"}};

struct FileInfo {
  std::string file;
  Molecule molecule;
  StructureCounts counts;
  int models = 0;
  std::vector<std::string> notes;
  double seconds = 0;
};

FileInfo inspect(const std::string& file) {
  FileInfo info;
  info.file = file;
  {
    const Timed timed(info.seconds);
    Logger logger;
    StructureFile structure = readStructure(file, {}, logger);
    info.models = structure.modelCount;
    info.molecule = std::move(structure.models.front());
    info.counts = countStructure(info.molecule);
    addMissingBonds(info.molecule, logger);
    info.notes = logger.notes();
  }
  return info;
}

std::string asJson(const FileInfo& info) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["file"] = info.file;
  json["atoms"] = info.counts.atoms;
  json["residues"] = info.counts.residues;
  json["chains"] = info.counts.chains;
  json["models"] = info.models;
  json["assemblies"] = Json::array();
  for (const Assembly& assembly : info.molecule.assemblies) json["assemblies"].push_back(assembly.id);
  for (const auto& [origin, name] : kOrigins) json["bonds"][name] = countBonds(info.molecule, origin);
  json["ligands"] = Json::object();
  for (const LigandCount& ligand : info.counts.ligands) json["ligands"][ligand.name] = ligand.count;
  json["box"] = nullptr;
  if (const std::optional<UnitCell>& cell = info.molecule.cell)
    json["box"] = {{"a", cell->a},         {"b", cell->b},       {"c", cell->c},
                   {"alpha", cell->alpha}, {"beta", cell->beta}, {"gamma", cell->gamma}};
  json["notes"] = info.notes;
  json["seconds"] = info.seconds;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string bondsText(const Molecule& molecule) {
  static constexpr const char* kMeaning[] = {"from connection records", "from CONECT",
                                             "from residue templates", "from distances"};
  std::string text = std::to_string(molecule.bonds.size());
  const char* separator = ": ";
  for (const auto& [origin, name] : kOrigins) {
    const std::size_t count = countBonds(molecule, origin);
    if (count == 0) continue;
    fmt::format_to(std::back_inserter(text), "{}{} {}", separator, count, kMeaning[static_cast<int>(origin)]);
    separator = ", ";
  }
  return text;
}

std::string asText(const FileInfo& info) {
  std::string text = info.file + "\n";
  const auto line = [&text](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "  {:<12}{}\n", name, value);
  };
  const bool several = info.models > 1;
  line("atoms", std::to_string(info.counts.atoms) + (several ? " (first model)" : ""));
  line("residues", std::to_string(info.counts.residues));
  line("chains", std::to_string(info.counts.chains));
  line("models", std::to_string(info.models));
  std::string assemblies;
  for (const Assembly& assembly : info.molecule.assemblies)
    assemblies += (assemblies.empty() ? "" : ", ") + assembly.id;
  line("assemblies", assemblies.empty() ? "none" : assemblies);
  line("bonds", bondsText(info.molecule));
  std::string ligands;
  for (const LigandCount& ligand : info.counts.ligands)
    ligands += fmt::format("{}{} {}", ligands.empty() ? "" : ", ", ligand.count, ligand.name);
  line("ligands", ligands.empty() ? "none" : ligands);
  const std::optional<UnitCell>& cell = info.molecule.cell;
  line("box", cell ? fmt::format("{} x {} x {} Angstrom, {} {} {} degrees", cell->a, cell->b, cell->c,
                                 cell->alpha, cell->beta, cell->gamma)
                   : "none");
  for (std::size_t i = 0; i < info.notes.size(); ++i) line(i == 0 ? "notes" : "", info.notes[i]);
  if (info.notes.empty()) line("notes", "none");
  line("time", fmt::format("{:.3f} s", info.seconds));
  return text;
}

}  // namespace

int runInfo(const std::vector<std::string>& arguments) {
  std::string file;
  bool json = false;
  const std::unique_ptr<CLI::App> app = makeCommandLine("info", kInfoDescription, kInfoExamples);
  app->add_option("FILE", file, "The structure file")->type_name("FILE");
  app->add_flag("--json", json,
                "Print JSON with the keys file atoms residues chains models\n"
                "assemblies bonds ligands box notes seconds")
      ->group("Other");
  if (!parseCommandLine(*app, arguments)) return 0;
  if (file.empty()) throw UsageError("no input; give a structure file, as in meniscus info FILE");
  const FileInfo info = inspect(file);
  const std::string text = json ? asJson(info) : asText(info);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return 0;
}

}  // namespace meniscus

#include "app/view/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/render_options.h"
#include "io/structure_reader.h"

namespace meniscus {
namespace {

constexpr std::size_t kMostPicks = 4;
// Steps back that are kept.
constexpr std::size_t kMostUndo = 1000;

// What a camera of the viewer's stands for.
constexpr std::array<std::string_view, 7> kCameraOptions{"orient",   "rotate", "focus", "target",
                                                         "distance", "near",   "far"};

bool isCameraOption(std::string_view name) {
  return std::find(kCameraOptions.begin(), kCameraOptions.end(), name) != kCameraOptions.end();
}

bool isSceneFile(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".mvsj" || extension == ".mvsx";
}

void addOptions(const GivenOptions& given, std::vector<std::string>& arguments) {
  for (const std::string& argument : asArguments(given)) arguments.push_back(argument);
}

void addFile(const Document& document, std::vector<std::string>& arguments) {
  if (document.isScene()) arguments.emplace_back("--scene");
  // A name that looks like an option is one of the folder.
  arguments.push_back(document.file().starts_with('-') ? "./" + document.file() : document.file());
}

std::string insertionCode(const Residue& residue) {
  return residue.insertionCode == ' ' ? "" : fmt::format(".{}", residue.insertionCode);
}

}  // namespace

std::string cidOf(const Molecule& molecule, std::uint32_t atom) {
  const Residue& residue = molecule.residues[molecule.residueOf[atom]];
  const std::string place =
      fmt::format("//{}/{}{}", molecule.chains[residue.chain].name, residue.number, insertionCode(residue));
  const std::string name(molecule.names[atom].view());
  const char altloc = molecule.altlocs[atom];
  const std::string alternative = altloc == ' ' ? "" : fmt::format(":{}", altloc);
  for (const std::string& cid :
       {fmt::format("{}/{}", place, name), fmt::format("{}/{}{}", place, name, alternative),
        fmt::format("{}({})/{}{}", place, residue.name, name, alternative)}) {
    try {
      if (selectAtoms(molecule, cid) == std::vector<std::uint32_t>{atom}) return cid;
    } catch (const UsageError&) {
      // A name that gemmi's syntax has no place for.
    }
  }
  return {};
}

std::string nameOf(const Molecule& molecule, std::uint32_t atom) {
  const Residue& residue = molecule.residues[molecule.residueOf[atom]];
  const std::string& chain = molecule.chains[residue.chain].name;
  std::string name = fmt::format("{} {}", residue.name, residue.number);
  if (residue.insertionCode != ' ') name += residue.insertionCode;
  name += fmt::format(" {}", molecule.names[atom].view());
  if (molecule.altlocs[atom] != ' ') name += fmt::format(" ({})", molecule.altlocs[atom]);
  return chain.empty() ? name : fmt::format("{}, chain {}", name, chain);
}

std::vector<const SceneObject*> objectsByMolecule(const Scene& scene) {
  std::vector<const SceneObject*> objects;
  for (const SceneObject& object : scene.objects)
    if (std::none_of(objects.begin(), objects.end(),
                     [&](const SceneObject* known) { return known->molecule == object.molecule; }))
      objects.push_back(&object);
  return objects;
}

void updatePicks(std::vector<Pick>& picks, const Scene& scene) {
  const std::vector<const SceneObject*> objects = objectsByMolecule(scene);
  std::erase_if(picks, [&](Pick& pick) {
    if (pick.cid.empty() || pick.molecule >= objects.size()) return true;
    const SceneObject& object = *objects[pick.molecule];
    const std::vector<std::uint32_t> atoms = selectAtoms(*object.molecule, pick.cid);
    if (atoms.size() != 1) return true;
    if (!pick.copy)
      pick.position =
          object.placements.front().transform * glm::dvec4(object.molecule->positions[atoms[0]], 1.0);
    return false;
  });
}

Document::Document(std::string file, GivenOptions given, bool isScene)
    : file_(std::move(file)), scene_(isScene || isSceneFile(file_)), given_(std::move(given)) {}

std::optional<std::string> Document::value(std::string_view option) const {
  std::optional<std::string> last;
  for (const auto& [name, text] : given_)
    if (name == option) last = text;
  return last;
}

std::vector<std::string> Document::values(std::string_view option) const {
  std::vector<std::string> all;
  for (const auto& [name, text] : given_)
    if (name == option) all.push_back(text);
  return all;
}

void Document::changed(std::string_view option, bool goesOn) {
  ++revision_;
  if (isCameraOption(option)) return;
  redo_.clear();
  if (goesOn && open_ == option) return;
  open_ = goesOn ? option : "";
  undo_.push_back(given_);
  if (undo_.size() > kMostUndo) undo_.erase(undo_.begin());
}

void Document::set(const std::string& option, const std::string& text, bool goesOn) {
  if (values(option) == std::vector<std::string>{text}) return;
  changed(option, goesOn);
  const auto named = [&](const auto& entry) { return entry.first == option; };
  const auto first = std::find_if(given_.begin(), given_.end(), named);
  if (first == given_.end()) {
    given_.emplace_back(option, text);
    return;
  }
  first->second = text;
  given_.erase(std::remove_if(first + 1, given_.end(), named), given_.end());
}

void Document::setAll(const std::string& option, const std::vector<std::string>& texts, bool goesOn) {
  if (values(option) == texts) return;
  changed(option, goesOn);
  std::erase_if(given_, [&](const auto& entry) { return entry.first == option; });
  for (const std::string& text : texts) given_.emplace_back(option, text);
}

void Document::remove(std::string_view option) {
  if (!has(option)) return;
  changed(option, false);
  std::erase_if(given_, [&](const auto& entry) { return entry.first == option; });
}

void Document::replace(GivenOptions given) {
  if (given == given_) return;
  changed("", false);
  given_ = std::move(given);
}

bool Document::undo() {
  if (undo_.empty()) return false;
  ++revision_;
  open_.clear();
  redo_.push_back(std::exchange(given_, std::move(undo_.back())));
  undo_.pop_back();
  return true;
}

bool Document::redo() {
  if (redo_.empty()) return false;
  ++revision_;
  open_.clear();
  undo_.push_back(std::exchange(given_, std::move(redo_.back())));
  redo_.pop_back();
  return true;
}

void Document::pick(Pick picked) {
  const auto known = std::find_if(picks.begin(), picks.end(), [&](const Pick& p) {
    return p.name == picked.name && p.position == picked.position;
  });
  if (known != picks.end()) {
    picks.erase(known);
    return;
  }
  if (picks.size() == kMostPicks) picks.clear();
  picks.push_back(std::move(picked));
}

std::optional<std::string> Document::measureOption() const {
  if (picks.size() < 2) return std::nullopt;
  std::string option;
  for (const Pick& p : picks) {
    if (p.copy || p.molecule != 0 || p.cid.empty()) return std::nullopt;
    option += (option.empty() ? "" : ";") + p.cid;
  }
  return option;
}

std::vector<std::string> renderArguments(const Document& document, const std::optional<Camera>& camera,
                                         ImageSize size, const std::string& output,
                                         std::optional<int> model) {
  std::vector<std::string> arguments;
  addFile(document, arguments);
  arguments.insert(arguments.end(), {"-o", output});
  GivenOptions given = document.given();
  const auto drop = [&](std::string_view option) {
    std::erase_if(given, [&](const auto& entry) { return entry.first == option; });
  };
  drop("size");
  given.emplace_back("size", fmt::format("{}x{}", size.width, size.height));
  if (model) {
    drop("model");
    given.emplace_back("model", std::to_string(*model));
  }
  if (camera) {
    for (const std::string_view option : kCameraOptions) drop(option);
    const glm::dquat& q = camera->orientation;
    const glm::dvec3& t = camera->target;
    given.emplace_back("orient", fmt::format("{},{},{},{}", q.w, q.x, q.y, q.z));
    given.emplace_back("target", fmt::format("{},{},{}", t.x, t.y, t.z));
    given.emplace_back("distance", fmt::format("{}", camera->distance));
    if (camera->nearest) given.emplace_back("near", fmt::format("{}", *camera->nearest));
    if (camera->farthest) given.emplace_back("far", fmt::format("{}", *camera->farthest));
  }
  addOptions(given, arguments);
  return arguments;
}

std::string commandLine(const std::vector<std::string>& arguments) {
  std::string line = "meniscus render";
  for (const std::string& argument : arguments) line += " " + shellQuoted(argument);
  return line;
}

Camera inPlaceOf(const Camera& own, Camera camera) {
  constexpr double kNothingBehind = 1e9;  // what --far takes at most
  if (own.nearest && !camera.nearest) camera.nearest = 0;
  if (own.farthest && !camera.farthest) camera.farthest = kNothingBehind;
  return camera;
}

std::vector<std::string> preparationArguments(const Document& document, ImageSize size) {
  std::vector<std::string> arguments;
  addFile(document, arguments);
  GivenOptions given = document.given();
  std::erase_if(given, [&](const auto& entry) {
    return entry.first == "size" || (document.oneByOne && entry.first == "model");
  });
  given.emplace_back("size", fmt::format("{}x{}", size.width, size.height));
  if (document.oneByOne && !document.isScene()) given.emplace_back("model", "all");
  // Names of pictures that are never written: what they name decides what a picture is.
  arguments.insert(arguments.end(), {"-o", document.isScene()  ? "{stem}-{state}.png"
                                           : document.oneByOne ? "{stem}-{model}.png"
                                                               : "{stem}.png"});
  addOptions(given, arguments);
  return arguments;
}

}  // namespace meniscus

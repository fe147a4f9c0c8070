#include "app/scene/mvs_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include "app/film.h"
#include "app/output_name.h"
#include "app/run_report.h"
#include "app/scene/color_names.h"
#include "app/scene/mvs_camera.h"
#include "app/scene/mvs_clip.h"
#include "app/scene/mvs_placement.h"
#include "app/scene/selectors.h"
#include "app/scene/settings.h"
#include "app/structure_pictures.h"
#include "core/atom_colors.h"
#include "core/bonds.h"
#include "core/displacement.h"
#include "core/error.h"
#include "core/primitives.h"
#include "io/structure_reader.h"

namespace meniscus {
namespace {

constexpr std::array<std::string_view, 21> kFormats{
    "mmcif",  "bcif", "pdb", "pdbqt", "gro",    "xyz", "mol", "sdf", "mol2",  "lammpstrj", "xtc",
    "nctraj", "dcd",  "trr", "psf",   "prmtop", "top", "map", "dx",  "dxbin", "vtp"};

// Radius of the thin sticks that stand for lines [Å]. A choice: a pixel or two in a picture of a protein.
constexpr double kLineRadius = 0.06;

/// A structure that was read, before it is placed.
struct ReadStructure {
  std::shared_ptr<Molecule> molecule;
  bool hasBonds = false, hasDisplacements = false;
};

class StateReader {
 public:
  StateReader(const std::string& name, MvsFile& file, const MvsState& state, const RenderOptions& given,
              std::map<std::string, ReadStructure>& structures)
      : name_(name), file_(file), state_(state), given_(given), structures_(structures) {}
  Preparation read();

 private:
  void readRoot();
  void readDownload(const MvsNode& node);
  void readStructure(const MvsNode& node, const JsonPlace& url);
  ReadStructure& load(const MvsNode& node, const JsonPlace& url, const RenderOptions& atoms);
  void readComponent(const MvsNode& node, ReadStructure& structure, std::vector<Placement> placements);
  void readRepresentation(const MvsNode& node, const MvsNode& component, ReadStructure& structure,
                          const std::vector<Placement>& placements, std::vector<std::uint32_t> atoms);
  void setLook(const MvsNode& node, SceneObject& object);
  void setColors(const MvsNode& node, bool schemeGiven, SceneObject& object);
  void addObject(SceneObject object, ReadStructure& structure);
  std::vector<std::uint32_t> componentAtoms(const MvsNode& node, const Molecule& molecule);
  RenderOptions optionsFrom(const std::optional<JsonPlace>& meniscus, SettingPlace place,
                            std::span<const std::string_view> others, GivenOptions* kept = nullptr);
  void leaveOut(const MvsNode& node, std::string_view reason) {
    made_.unsupported.push_back(fmt::format("{}: {}", node.place().path(), reason));
  }

  const std::string& name_;
  MvsFile& file_;
  const MvsState& state_;
  const RenderOptions& given_;
  Preparation made_;
  Picture picture_;
  MvsCamera camera_;
  double atoms_ = 0, bytes_ = 0;            // of all objects
  std::optional<double> surfaceOpacity_;    // of the first surface
  std::vector<const MvsNode*> wholeFocus_;  // focus nodes under the root, about everything
  std::map<std::string, ReadStructure>& structures_;
};

std::string joined(const GivenOptions& options) {
  std::string text;
  for (const std::string& argument : asArguments(options)) text += " " + argument;
  return text;
}

RenderOptions StateReader::optionsFrom(const std::optional<JsonPlace>& meniscus, SettingPlace place,
                                       std::span<const std::string_view> others, GivenOptions* kept) {
  GivenOptions options;
  if (meniscus) options = settingsOf(*meniscus, place, others);
  if (kept) *kept = options;
  static const RenderOptions plain = parseSettings({});
  if (!meniscus) return plain;
  return namingKeys(*meniscus, [&] { return parseSettings(asArguments(options)); });
}

Preparation StateReader::read() {
  readRoot();
  RenderOptions& options = picture_.options;
  if (picture_.scene.objects.empty())
    throw InputError(
        fmt::format("{}: draws nothing{}", state_.root.place().path(),
                    made_.unsupported.empty() ? "" : " that is supported; " + made_.unsupported[0]));
  FitSpheres all;
  addFitSpheres(picture_.scene.objects, all);
  for (const MvsNode* node : wholeFocus_) camera_.readFocus(*node, all, made_.unsupported);
  picture_.scene.camera = camera_.camera(options, all);
  // What is set for the picture, here or on the command line, has its way.
  const auto setsOpacity = [](const auto& option) { return option.first == "opacity"; };
  if (surfaceOpacity_ && std::none_of(options.given.begin(), options.given.end(), setsOpacity))
    options.surface.opacity = *surfaceOpacity_;
  picture_.input = name_;
  picture_.place.state = state_.key;
  picture_.output = OutputPattern(given_.output).nameFor(name_, picture_.place);
  made_.pictures.push_back(std::move(picture_));
  return std::move(made_);
}

void StateReader::readRoot() {
  static constexpr std::array<std::string_view, 1> kOthers{"made_from"};
  const std::optional<JsonPlace> meniscus = state_.root.meniscus();
  // What is given on the command line comes after what the scene says, and so has its way.
  GivenOptions own;
  optionsFrom(meniscus, SettingPlace::picture, kOthers, &own);  // names the key of what is wrong
  GivenOptions both = own;
  both.insert(both.end(), given_.given.begin(), given_.given.end());
  RenderOptions& options = picture_.options;
  options = parseSettings(asArguments(both));
  options.output = given_.output;
  options.quadrics = given_.quadrics;
  requireSettingsConsistent(options);

  const std::string file = std::filesystem::path(name_).filename().string();
  picture_.source = file;
  picture_.command = fmt::format("meniscus render --scene {}{}", file, given_.pictureOptions);
  if (const auto made = meniscus ? meniscus->find("made_from") : std::nullopt) {
    picture_.source = made->at("source").string();
    picture_.command = made->at("command").string() + given_.pictureOptions;
  }
  Background& background = picture_.scene.background;
  for (const MvsNode& child : state_.root.children()) {
    if (child.kind() == "download") {
      readDownload(child);
    } else if (child.kind() == "camera") {
      camera_.readCamera(child, made_.unsupported);
    } else if (child.kind() == "focus") {
      wholeFocus_.push_back(&child);
    } else if (child.kind() == "canvas") {
      child.listOtherParameters({"background_color"}, made_.unsupported);
      if (const auto color = child.find("background_color")) {
        const std::optional<Rgb> rgb = colorByName(color->string());
        if (!rgb)
          color->fail(fmt::format("'{}' is no colour; give an X11 name or '#RRGGBB'", color->string()));
        background = {*rgb, false};
      }
    } else if (child.kind() == "transition" || child.kind() == "animation") {
      leaveOut(child, "has no meaning in a still picture");
    } else {
      leaveOut(child, fmt::format("nodes of kind '{}' are not supported", child.kind()));
    }
  }
  const auto names = [&](const auto& entry) { return entry.first == "background"; };
  if (std::any_of(both.begin(), both.end(), names)) background = options.background;
}

void StateReader::readDownload(const MvsNode& node) {
  const JsonPlace url = node.at("url");
  node.listOtherParameters({"url"}, made_.unsupported);
  for (const MvsNode& parse : node.children()) {
    if (parse.kind() != "parse") {
      leaveOut(parse, fmt::format("nodes of kind '{}' are not supported", parse.kind()));
      continue;
    }
    const JsonPlace format = parse.at("format");
    if (std::find(kFormats.begin(), kFormats.end(), format.string()) == kFormats.end())
      format.fail(fmt::format("there is no format called '{}'", format.string()));
    if (!isReadFormat(format.string())) {
      leaveOut(parse, fmt::format("files of format '{}' are not read", format.string()));
      continue;
    }
    for (const MvsNode& child : parse.children()) {
      if (child.kind() == "structure") {
        readStructure(child, url);
      } else {
        leaveOut(child, fmt::format("nodes of kind '{}' are not supported", child.kind()));
      }
    }
  }
}

/// The structure of a node; the same file read in the same way is the same one.
ReadStructure& StateReader::load(const MvsNode& node, const JsonPlace& url, const RenderOptions& atoms) {
  StructureOptions options = atoms.structure;
  options.modelIndex = 0;
  if (const auto index = node.find("model_index")) options.modelIndex = index->integer();
  const std::optional<JsonPlace> meniscus = node.meniscus();
  const std::string key = fmt::format("{}\n{}\n{}", url.string(), *options.modelIndex,
                                      meniscus ? joined(settingsOf(*meniscus, SettingPlace::structure)) : "");
  ReadStructure& structure = structures_[key];
  if (structure.molecule) return structure;
  const Timed timed(made_.parseSeconds);
  Logger logger;
  try {
    StructureFile read = readStructureBytes(file_.resources().bytes(url), url.string(), options, logger);
    structure.molecule = std::make_shared<Molecule>(std::move(read.models.front()));
  } catch (const Error& error) {
    if (std::string_view(error.what()).starts_with(url.path())) throw;
    url.fail(error.what());
  }
  for (const std::string& note : logger.notes())
    made_.notes.push_back(fmt::format("{}: {}", url.string(), note));
  return structure;
}

void StateReader::readStructure(const MvsNode& node, const JsonPlace& url) {
  node.listOtherParameters({"type", "model_index", "assembly_id", "radius", "ijk_min", "ijk_max"},
                           made_.unsupported);
  RenderOptions atoms = optionsFrom(node.meniscus(), SettingPlace::structure, {});
  const auto given = [&](std::string_view option) {
    const std::optional<JsonPlace> meniscus = node.meniscus();
    return meniscus && meniscus->find(option).has_value();
  };
  if (!given("waters")) atoms.structure.waters = Waters::on;  // `all` means all
  ReadStructure& structure = load(node, url, atoms);
  std::vector<Placement> placements = placementsOf(node, *structure.molecule);
  if (atoms.replicate != glm::ivec3(1))
    placements = replicate(*structure.molecule, placements, atoms.replicate);
  movePlacements(node, *structure.molecule, placements, made_.unsupported);
  for (const MvsNode& child : node.children()) {
    if (child.kind() == "component") {
      readComponent(child, structure, placements);
    } else if (child.kind() == "tooltip_from_uri" || child.kind() == "tooltip_from_source") {
      leaveOut(child, "tooltips have no meaning in a picture");
    } else if (child.kind() != "transform" && child.kind() != "instance") {
      leaveOut(child, fmt::format("nodes of kind '{}' are not supported", child.kind()));
    }
  }
}

// custom.meniscus: "select" chooses by gemmi's syntax instead, "except" is a list of such choices to leave
// out.
std::vector<std::uint32_t> StateReader::componentAtoms(const MvsNode& node, const Molecule& molecule) {
  std::vector<std::uint32_t> atoms;
  const std::optional<JsonPlace> meniscus = node.meniscus();
  const auto chosen = [&](const JsonPlace& cid) {
    try {
      return selectAtoms(molecule, cid.string());
    } catch (const UsageError& error) {
      cid.fail(error.what());
    }
  };
  if (meniscus)
    for (const std::string& key : meniscus->keys())
      if (key != "select" && key != "except")
        meniscus->at(key).fail("there is no such setting here; see docs/scene.md");
  if (const auto cid = meniscus ? meniscus->find("select") : std::nullopt) {
    atoms = chosen(*cid);
  } else if (const auto selector = node.find("selector")) {
    atoms = selectComponent(molecule, *selector, made_.unsupported);
  } else {
    for (std::uint32_t i = 0; i < molecule.atomCount(); ++i) atoms.push_back(i);
  }
  if (const auto except = meniscus ? meniscus->find("except") : std::nullopt) {
    for (const JsonPlace& cid : except->items()) {
      std::vector<std::uint32_t> rest;
      const std::vector<std::uint32_t> out = chosen(cid);
      std::set_difference(atoms.begin(), atoms.end(), out.begin(), out.end(), std::back_inserter(rest));
      atoms = std::move(rest);
    }
  }
  return atoms;
}

void StateReader::readComponent(const MvsNode& node, ReadStructure& structure,
                                std::vector<Placement> placements) {
  node.listOtherParameters({"selector"}, made_.unsupported);
  const std::vector<std::uint32_t> atoms = componentAtoms(node, *structure.molecule);
  if (atoms.empty()) {
    if (!node.children().empty()) made_.notes.push_back(node.place().path() + ": chooses no atoms");
    return;
  }
  movePlacements(node, *structure.molecule, placements, made_.unsupported);
  const auto spheres = [&] {
    const double count = placedAtomCount(*structure.molecule, atoms, placements);
    requireMemory(name_, count, count,
                  bytesOfCopies(*structure.molecule, atoms, placements, Representation::spacefill));
    requireIds(name_, count, count);
    SceneObject whole;
    whole.molecule = structure.molecule;
    whole.placements = placements;
    whole.atoms = atoms;
    FitSpheres fit;
    addFitSpheres(whole, {}, fit);
    return fit;
  };
  for (const MvsNode& child : node.children()) {
    if (child.kind() == "representation") {
      readRepresentation(child, node, structure, placements, atoms);
    } else if (child.kind() == "focus") {
      camera_.readFocus(child, spheres(), made_.unsupported);
    } else if (child.kind() == "label") {
      child.listOtherParameters({"text"}, made_.unsupported);
      picture_.scene.labels.push_back(
          labelOf(structure.molecule, placements, atoms, child.at("text").string()));
    } else if (child.kind() == "tooltip") {
      leaveOut(child, "tooltips have no meaning in a picture");
    } else if (child.kind() != "transform" && child.kind() != "instance") {
      leaveOut(child, fmt::format("nodes of kind '{}' are not supported", child.kind()));
    }
  }
}

/// Representation and sizes, from the node's type and parameters.
void StateReader::setLook(const MvsNode& node, SceneObject& object) {
  const JsonPlace type = node.at("type");
  double size = 1;
  if (const auto factor = node.find("size_factor")) {
    size = factor->number();
    if (!(size >= 0.001 && size <= 1000)) factor->fail("must be from 0.001 to 1000");
  }
  const std::string& name = type.string();
  if (name == "spacefill") {
    object.representation = Representation::spacefill;
    object.radiusScale = size;
  } else if (name == "ball_and_stick") {
    object.representation = Representation::ballAndStick;
    object.ballScale *= size;
    object.stickRadius *= size;
  } else if (name == "line") {
    object.representation = Representation::licorice;
    object.licoriceRadius = kLineRadius * size;
  } else if (name == "cartoon" || name == "backbone" || name == "putty") {
    object.representation = name == "cartoon"    ? Representation::cartoon
                            : name == "backbone" ? Representation::backbone
                                                 : Representation::putty;
    object.ribbonScale = size;
  } else if (name == "surface") {
    object.representation = Representation::surface;
    object.radiusScale = size;
    if (const auto kind = node.find("surface_type")) {
      if (kind->string() == "molecular") {
        made_.unsupported.push_back(kind->path() +
                                    ": drawn as the metaballs' surface, which is as 'gaussian'");
      } else if (kind->string() != "gaussian") {
        kind->fail(fmt::format("'{}' is neither molecular nor gaussian", kind->string()));
      }
    }
  } else {
    type.fail(fmt::format("there is no representation called '{}'", name));
  }
}

void StateReader::readRepresentation(const MvsNode& node, const MvsNode& component, ReadStructure& structure,
                                     const std::vector<Placement>& placements,
                                     std::vector<std::uint32_t> atoms) {
  const std::optional<JsonPlace> meniscus = node.meniscus();
  const auto custom = [&](std::string_view key) { return meniscus ? meniscus->find(key) : std::nullopt; };
  if (!custom("representation") && node.at("type").string() == "carbohydrate") {
    leaveOut(node, "the representation 'carbohydrate' is not supported");
    return;
  }
  node.listOtherParameters({"type", "size_factor", "ignore_hydrogens", "surface_type"}, made_.unsupported);
  const RenderOptions look = optionsFrom(meniscus, SettingPlace::look, {});
  SceneObject object = objectAsAsked(look, structure.molecule);
  object.placements = placements;
  if (!custom("representation")) setLook(node, object);
  if (const auto ignore = node.find("ignore_hydrogens"); ignore && ignore->boolean())
    std::erase_if(atoms, [&](std::uint32_t atom) { return structure.molecule->elements[atom] == 1; });
  if (atoms.empty()) {
    made_.notes.push_back(component.place().path() + ": has hydrogens only, which are not to be drawn");
    return;
  }
  // All atoms are written as none, as the command line does: the same scene is the same picture.
  if (atoms.size() < structure.molecule->atomCount()) object.atoms = std::move(atoms);
  setColors(node, custom("color").has_value() || custom("carbons").has_value(), object);
  std::vector<MvsClip> clips;
  double opacity = 1;
  for (const MvsNode& child : node.children()) {
    if (child.kind() == "clip") {
      clips.emplace_back(child, made_.unsupported);
    } else if (child.kind() == "opacity") {
      opacity = child.at("opacity").number();
      if (!(opacity >= 0 && opacity <= 1)) child.at("opacity").fail("must be from 0 to 1");
      if (opacity < 1 && object.representation != Representation::surface)
        leaveOut(child, "only surfaces can be translucent");
    } else if (child.kind() != "color") {
      leaveOut(child, fmt::format("nodes of kind '{}' are not supported", child.kind()));
    }
  }
  if (object.representation == Representation::surface) {
    if (surfaceOpacity_ && *surfaceOpacity_ != opacity)
      leaveOut(node, "all surfaces of a picture are as opaque as the first");
    surfaceOpacity_ = surfaceOpacity_.value_or(opacity);
  }
  if (clips.empty()) {
    addObject(std::move(object), structure);
    return;
  }
  // Each copy is cut in its own place.
  const Molecule& molecule = *structure.molecule;
  for (const Placement& placement : placements) {
    SceneObject part = object;
    part.placements = {placement};
    part.atoms.clear();
    const auto keep = [&](std::uint32_t atom) {
      const glm::dvec3 point(placement.transform * glm::dvec4(molecule.positions[atom], 1.0));
      if (std::none_of(clips.begin(), clips.end(), [&](const MvsClip& clip) { return clip.cuts(point); }))
        part.atoms.push_back(atom);
    };
    if (object.atoms.empty()) {
      for (std::uint32_t atom = 0; atom < molecule.atomCount(); ++atom) keep(atom);
    } else {
      std::for_each(object.atoms.begin(), object.atoms.end(), keep);
    }
    if (!part.atoms.empty()) addObject(std::move(part), structure);
  }
}

/// MolViewSpec's default is white; what is given later has its way over what is given earlier.
void StateReader::setColors(const MvsNode& node, bool schemeGiven, SceneObject& object) {
  const Molecule& molecule = *object.molecule;
  if (!schemeGiven) object.coloring = {ColorScheme::uniform, 0xFFFFFF, false};
  for (const MvsNode& child : node.children()) {
    if (child.kind() != "color") continue;
    child.listOtherParameters({"color", "selector"}, made_.unsupported);
    Rgb rgb = 0xFFFFFF;
    if (const auto color = child.find("color")) {
      const std::optional<Rgb> known = colorByName(color->string());
      if (!known)
        color->fail(fmt::format("'{}' is no colour; give an X11 name or '#RRGGBB'", color->string()));
      rgb = *known;
    }
    const auto selector = child.find("selector");
    if (!selector || selector->json() == "all") {
      object.coloring = {ColorScheme::uniform, rgb, false};
      object.colors.clear();
      continue;
    }
    if (object.colors.empty()) object.colors = colorAtoms(molecule, object.coloring);
    for (const std::uint32_t atom : selectComponent(molecule, *selector, made_.unsupported))
      object.colors[atom] = rgb;
  }
}

void StateReader::addObject(SceneObject object, ReadStructure& structure) {
  const double count = placedAtomCount(*object.molecule, object.atoms, object.placements);
  atoms_ += count;
  bytes_ += bytesOfCopies(*object.molecule, object.atoms, object.placements, object.representation);
  requireMemory(name_, atoms_, atoms_, bytes_);
  requireIds(name_, count, count);
  Logger logger;
  if (needsBonds(object.representation) && !structure.hasBonds) {
    const Timed timed(made_.bondsSeconds);
    addMissingBonds(*structure.molecule, logger);
    structure.hasBonds = true;
  }
  if (object.representation == Representation::ellipsoids && !structure.hasDisplacements) {
    noteOddDisplacements(*structure.molecule, logger);
    structure.hasDisplacements = true;
  }
  made_.notes.insert(made_.notes.end(), logger.notes().begin(), logger.notes().end());
  picture_.scene.objects.push_back(std::move(object));
}

}  // namespace

Preparation scenePictures(const std::string& name, MvsFile& file, const RenderOptions& options) {
  const OutputPattern pattern(options.output);
  if (file.states().size() > 1 && !pattern.namesState() && !isFilm(options.output))
    throw InputError(
        fmt::format("{}: holds {} states, which would all be written to '{}'; put {{state}} into it", name,
                    file.states().size(), options.output));
  Preparation all;
  all.unsupported = file.notes();
  std::map<std::string, ReadStructure> structures;  // of all states
  for (const MvsState& state : file.states()) {
    Preparation one = StateReader(name, file, state, options, structures).read();
    all.pictures.push_back(std::move(one.pictures.front()));
    all.notes.insert(all.notes.end(), one.notes.begin(), one.notes.end());
    all.unsupported.insert(all.unsupported.end(), one.unsupported.begin(), one.unsupported.end());
    all.parseSeconds += one.parseSeconds;
    all.bondsSeconds += one.bondsSeconds;
  }
  return all;
}

void requireAllSupported(const Preparation& scene) {
  if (scene.unsupported.empty()) return;
  const std::size_t more = scene.unsupported.size() - 1;
  throw InputError(scene.unsupported.front() + (more > 0 ? fmt::format(" (and {} more)", more) : "") +
                   " (--strict)");
}

}  // namespace meniscus

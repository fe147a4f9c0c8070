#include "app/structure_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "app/film.h"
#include "app/measurement.h"
#include "app/option_camera.h"
#include "app/output_name.h"
#include "app/run_report.h"
#include "app/scene/mvs_camera.h"
#include "app/scene/settings.h"
#include "core/bonds.h"
#include "core/camera_fit.h"
#include "core/displacement.h"
#include "core/error.h"
#include "core/primitives.h"
#include "core/ribbon_primitives.h"
#include "io/structure_reader.h"

namespace meniscus {
namespace {

using Molecules = std::vector<std::shared_ptr<const Molecule>>;
using Objects = std::vector<SceneObject>;

// A file as it was read with some options.
struct ReadStructure {
  StructureOptions options;
  StructureFile file;
  std::vector<std::string> notes;
  double seconds = 0;
};

ReadStructure readFor(const StructureOptions& options, const std::string& file, std::string bytes) {
  ReadStructure read;
  read.options = options;
  Logger logger;
  {
    const Timed timed(read.seconds);
    read.file = readStructureBytes(std::move(bytes), file, options, logger);
  }
  read.notes = logger.notes();
  return read;
}

class StructurePictures {
 public:
  StructurePictures(const std::string& file, const RenderOptions& options) : file_(file), options_(options) {}
  Preparation make(ReadStructure read);

 private:
  Molecules moleculesOf(ReadStructure read);
  void requireMemoryFor(const Molecules& molecules) const;
  bool draws(Representation representation) const;
  bool drawsBonds() const;
  SceneObject placedObject(std::shared_ptr<const Molecule> molecule) const;
  Objects objectsFor(const std::shared_ptr<const Molecule>& molecule) const;
  Camera cameraFor(const std::vector<Objects>& models) const;
  void addLabels(const SceneObject& object, Scene& scene) const;
  void addPicture(Scene scene, int model);
  [[noreturn]] void throwMatchesNothing(const char* option, const std::string& cid) const;

  const std::string& file_;
  const RenderOptions& options_;
  Preparation made_;
  StructureFormat format_ = StructureFormat::mmcif;
};

Preparation StructurePictures::make(ReadStructure read) {
  const Molecules molecules = moleculesOf(std::move(read));
  requireMemoryFor(molecules);
  std::vector<Objects> models;
  for (const auto& molecule : molecules) models.push_back(objectsFor(molecule));
  Scene scene;
  scene.background = options_.background;
  scene.camera = cameraFor(models);

  const OutputPattern pattern(options_.output.empty() ? options_.exportMesh : options_.output);
  if (!pattern.namesModel() && !isFilm(options_.output)) {
    for (const Objects& objects : models) addLabels(objects.front(), scene);
    for (Objects& objects : models)
      std::move(objects.begin(), objects.end(), std::back_inserter(scene.objects));
    addPicture(std::move(scene), molecules.front()->model);
    return std::move(made_);
  }
  std::set<int> numbers;
  for (const auto& molecule : molecules) numbers.insert(molecule->model);
  const bool namesModel = pattern.namesModel() || OutputPattern(options_.exportMesh).namesModel();
  if (namesModel && numbers.size() < molecules.size())
    throw InputError(
        fmt::format("'{}': has several models of the same number, so {{model}} cannot tell them apart; "
                    "choose one with --model",
                    file_));
  for (Objects& objects : models) {
    const int model = objects.front().molecule->model;
    scene.labels.clear();
    scene.dashes.clear();
    addLabels(objects.front(), scene);
    scene.objects = std::move(objects);
    addPicture(scene, model);
  }
  return std::move(made_);
}

void StructurePictures::addPicture(Scene scene, int model) {
  Picture picture;
  picture.input = file_;
  picture.place.model = model;
  if (!options_.output.empty()) picture.output = OutputPattern(options_.output).nameFor(file_, picture.place);
  if (!options_.exportMesh.empty())
    picture.exported = OutputPattern(options_.exportMesh).nameFor(file_, picture.place);
  picture.format = format_;
  picture.options = options_;
  picture.scene = std::move(scene);
  // The names of folders and of the output are left out: they say nothing about the picture, and the same
  // picture should be the same bytes wherever it is made.
  picture.source = std::filesystem::path(file_).filename().string();
  picture.command = "meniscus render " + picture.source + options_.pictureOptions;
  made_.pictures.push_back(std::move(picture));
}

Molecules StructurePictures::moleculesOf(ReadStructure read) {
  Logger logger;
  format_ = read.file.format;
  made_.modelCount = read.file.modelCount;
  made_.parseSeconds = read.seconds;
  Molecules molecules;
  for (Molecule& molecule : read.file.models) {
    if (drawsBonds()) {
      const Timed timed(made_.bondsSeconds);
      addMissingBonds(molecule, logger);
    }
    if (draws(Representation::ellipsoids)) noteOddDisplacements(molecule, logger);
    molecules.push_back(std::make_shared<const Molecule>(std::move(molecule)));
  }
  made_.notes = std::move(read.notes);
  made_.notes.insert(made_.notes.end(), logger.notes().begin(), logger.notes().end());
  return molecules;
}

SceneObject StructurePictures::placedObject(std::shared_ptr<const Molecule> molecule) const {
  SceneObject object = objectAsAsked(options_, std::move(molecule));
  if (!options_.assembly.empty()) object.placements = placeAssembly(*object.molecule, options_.assembly);
  if (options_.replicate != glm::ivec3(1))
    object.placements = replicate(*object.molecule, object.placements, options_.replicate);
  return object;
}

void StructurePictures::requireMemoryFor(const Molecules& molecules) const {
  const glm::dvec3 n(options_.replicate);
  const double lattice = n.x * n.y * n.z;
  double atoms = 0, placed = 0, bytes = 0;
  for (const auto& molecule : molecules) {
    const std::vector<Placement> placements =
        options_.assembly.empty() ? placeOnce(*molecule) : placeAssembly(*molecule, options_.assembly);
    atoms += static_cast<double>(molecule->atomCount());
    placed += lattice * placedAtomCount(*molecule, {}, placements);
    double most = bytesOfCopies(*molecule, {}, placements, options_.representation, lattice);
    for (const ShownApart& shown : options_.shown)
      most = std::max(most, bytesOfCopies(*molecule, {}, placements, shown.representation, lattice));
    bytes += most;
  }
  requireMemory(file_, atoms, placed, bytes);
  requireIds(file_, atoms, placed);
}

bool StructurePictures::draws(Representation representation) const {
  return options_.representation == representation ||
         std::any_of(options_.shown.begin(), options_.shown.end(),
                     [&](const ShownApart& shown) { return shown.representation == representation; });
}

bool StructurePictures::drawsBonds() const {
  return needsBonds(options_.representation) ||
         std::any_of(options_.shown.begin(), options_.shown.end(),
                     [&](const ShownApart& shown) { return needsBonds(shown.representation); });
}

// The molecule in its representation, but for the atoms that --show draws in one of their own, and without
// those that --hide names.
Objects StructurePictures::objectsFor(const std::shared_ptr<const Molecule>& molecule) const {
  const SceneObject whole = placedObject(molecule);
  if (options_.shown.empty() && options_.hidden.empty()) return {whole};
  const std::size_t hidden = options_.shown.size() + 1;
  std::vector<std::size_t> owner(molecule->atomCount(), 0);
  const auto give = [&](const char* option, const std::string& cid, std::size_t to) {
    const std::vector<std::uint32_t> atoms = selectAtoms(*molecule, cid);
    if (atoms.empty()) throwMatchesNothing(option, cid);
    for (const std::uint32_t atom : atoms) owner[atom] = to;
  };
  for (std::size_t i = 0; i < options_.shown.size(); ++i) give("--show", options_.shown[i].cid, i + 1);
  for (const std::string& cid : options_.hidden) give("--hide", cid, hidden);
  Objects objects(hidden, whole);
  for (std::size_t i = 0; i < options_.shown.size(); ++i) {
    objects[i + 1].representation = options_.shown[i].representation;
    if (options_.shown[i].coloring) objects[i + 1].coloring = *options_.shown[i].coloring;
  }
  for (std::uint32_t atom = 0; atom < owner.size(); ++atom)
    if (owner[atom] != hidden) objects[owner[atom]].atoms.push_back(atom);
  std::erase_if(objects, [](const SceneObject& object) { return object.atoms.empty(); });
  if (objects.empty()) throw InputError(fmt::format("'{}': --hide leaves nothing to draw; hide less", file_));
  return objects;
}

void StructurePictures::addLabels(const SceneObject& object, Scene& scene) const {
  const auto chosen = [&](const char* option, const std::string& cid) {
    std::vector<std::uint32_t> atoms = selectAtoms(*object.molecule, cid);
    if (atoms.empty()) throwMatchesNothing(option, cid);
    return atoms;
  };
  for (const auto& [cid, text] : options_.labels)
    scene.labels.push_back(labelOf(object.molecule, object.placements, chosen("--label", cid), text));
  for (const std::vector<std::string>& measured : options_.measures) {
    std::vector<glm::dvec3> points;
    for (const std::string& cid : measured) {
      const std::vector<std::uint32_t> atoms = chosen("--measure", cid);
      glm::dvec3 sum(0.0);
      for (const std::uint32_t atom : atoms) sum += object.molecule->positions[atom];
      const glm::dvec3 middle = sum / static_cast<double>(atoms.size());
      points.emplace_back(object.placements.front().transform * glm::dvec4(middle, 1.0));
    }
    addMeasure(points, options_.labelColors.text, scene);
  }
}

void StructurePictures::throwMatchesNothing(const char* option, const std::string& cid) const {
  throw InputError(fmt::format("'{}': {} '{}' matches none of the atoms that are drawn; see meniscus info",
                               file_, option, cid));
}

// One camera for all models of a file, so that they can be compared and make a film; it looks as suits the
// first.
Camera StructurePictures::cameraFor(const std::vector<Objects>& models) const {
  FitSpheres spheres, first;
  for (const Objects& objects : models) {
    for (const SceneObject& object : objects) {
      const bool ofFirst = &objects == &models.front();
      FitSpheres all;
      if (options_.focus.empty() || ofFirst) addFitSpheres(object, {}, all);
      if (ofFirst) first.add(all);
      if (options_.focus.empty()) {
        spheres.add(all);
      } else if (const auto atoms = selectAtoms(*object.molecule, options_.focus); !atoms.empty()) {
        addFitSpheres(object, atoms, spheres);
      }
    }
  }
  if (spheres.empty() && options_.focus.empty())
    throw InputError(fmt::format(
        "'{}': has nothing that its representation draws; cartoon, backbone and putty are for chains "
        "of protein or nucleic acid, others for any atoms",
        file_));
  if (spheres.empty())
    throw InputError(
        fmt::format("'{}': --focus '{}' matches none of the atoms that are drawn; see meniscus info", file_,
                    options_.focus));

  Camera camera = lensOf(options_);
  switch (options_.orientation.kind) {
    case Orientation::Kind::principal:
      camera.orientation = principalAxes(first, options_.size.height > options_.size.width);
      break;
    case Orientation::Kind::axis:
      camera.orientation = lookDownAxis(options_.orientation.axis);
      break;
    case Orientation::Kind::quaternion:
      camera.orientation = options_.orientation.quaternion;
      break;
  }
  camera.orientation = rotatedBy(camera.orientation, options_.rotationDeg);
  return withViewpoint(fitted(camera, options_.size, spheres), options_);
}

// Options of a panel: those of all, and then its own.
RenderOptions panelOptions(const RenderOptions& all, const PanelOptions& panel, ImageSize size) {
  GivenOptions shared = all.given;
  std::erase_if(shared, [](const auto& option) {
    // What a style stands for is there beside it, and gives way to what a panel says.
    return option.first == "panel" || option.first == "divider" || option.first == "size" ||
           option.first == "style";
  });
  std::vector<std::string> arguments = asArguments(shared);
  arguments.insert(arguments.end(), panel.arguments.begin(), panel.arguments.end());
  RenderOptions options = parseSettings(arguments);
  options.output = all.output;
  options.quadrics = all.quadrics;
  options.size = size;
  requireSettingsConsistent(options);
  return options;
}

// It has nothing of its own to show.
Picture errorPanel(const Picture& first) {
  Picture panel;
  panel.options = first.options;
  panel.scene.camera = first.scene.camera;
  panel.scene.background = first.scene.background;
  return panel;
}

// That of the first panel, at a distance that suits all of them.
Camera cameraOfPanels(const Preparation& all, const RenderOptions& options, ImageSize size) {
  Camera camera = all.pictures.front().scene.camera;
  if (!options.focus.empty()) return camera;
  FitSpheres spheres;
  for (const Picture& picture : all.pictures)
    for (const Picture& panel : picture.panels) addFitSpheres(panel.scene.objects, spheres);
  return withViewpoint(fitted(camera, size, spheres), options);
}

Preparation picturesWithPanels(const std::string& file, const std::string& bytes,
                               const RenderOptions& options) {
  const std::vector<PanelPlace> places = placePanels(options.panels.size(), options.size, options.divider);
  Preparation all;
  std::optional<ReadStructure> read;  // panels mostly show the same atoms
  for (std::size_t i = 0; i < options.panels.size(); ++i) {
    if (options.panels[i].error) {
      for (Picture& picture : all.pictures) picture.panels.push_back(errorPanel(picture.panels.front()));
      continue;
    }
    const RenderOptions own = panelOptions(options, options.panels[i], places[i].picture);
    if (!read || own.structure != read->options) read = readFor(own.structure, file, bytes);
    const bool last = i + 1 == options.panels.size();
    Preparation made = StructurePictures(file, own).make(last ? std::move(*read) : *read);
    read->seconds = 0;
    if (i == 0) {
      all = made;
    } else {
      all.parseSeconds += made.parseSeconds;
      all.bondsSeconds += made.bondsSeconds;
      for (std::string& note : made.notes)
        if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end())
          all.notes.push_back(std::move(note));
    }
    if (made.pictures.size() != all.pictures.size())
      throw InputError(
          fmt::format("'{}': its panels have different numbers of models; give them one --model", file));
    for (std::size_t k = 0; k < made.pictures.size(); ++k)
      all.pictures[k].panels.push_back(std::move(made.pictures[k]));
  }
  const Camera camera = cameraOfPanels(all, options, places.front().picture);
  for (Picture& picture : all.pictures) {
    picture.scene.camera = camera;
    picture.options = options;
    picture.command = "meniscus render " + picture.source + options.pictureOptions;
  }
  return all;
}

}  // namespace

SceneObject objectAsAsked(const RenderOptions& options, std::shared_ptr<const Molecule> molecule) {
  SceneObject object;
  object.placements = placeOnce(*molecule);
  object.molecule = std::move(molecule);
  object.representation = options.representation;
  object.coloring = options.coloring;
  object.radii = options.radii;
  object.ballScale = options.ballScale.value_or(object.ballScale);
  object.stickRadius = options.stickRadius.value_or(object.stickRadius);
  object.licoriceRadius = options.stickRadius.value_or(object.licoriceRadius);
  object.ellipsoidStickRadius = options.stickRadius.value_or(object.ellipsoidStickRadius);
  object.ribbonScale = options.ribbonScale;
  object.probability = options.probability;
  object.surface = options.surfaceShape;
  return object;
}

Label labelOf(std::shared_ptr<const Molecule> molecule, const std::vector<Placement>& placements,
              std::vector<std::uint32_t> atoms, const std::string& text) {
  SceneObject labelled;
  labelled.molecule = std::move(molecule);
  labelled.placements = placements;
  labelled.atoms = std::move(atoms);
  FitSpheres spheres;
  addFitSpheres(labelled, {}, spheres);
  const BoundingSphere bounds = boundsOf(spheres);
  return {text, bounds.center, bounds.radius};
}

double placedAtomCount(const Molecule& molecule, const std::vector<std::uint32_t>& atoms,
                       const std::vector<Placement>& placements) {
  std::vector<double> before(molecule.residues.size() + 1);  // a residue: atoms of those before it
  for (const std::uint32_t atom : atoms) ++before[molecule.residueOf[atom] + 1];
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    if (atoms.empty()) before[r + 1] = molecule.residues[r].atoms.count;
    before[r + 1] += before[r];
  }
  double count = 0;
  for (const Placement& placement : placements)
    for (const IndexRange& range : placement.residues) count += before[range.end()] - before[range.first];
  return count;
}

double bytesPerAtom(Representation representation) {
  if (representation == Representation::ellipsoids) return 250;
  if (needsBonds(representation)) return 210;
  return representation == Representation::surface ? 130 : 120;
}

double bytesOfCopies(const Molecule& molecule, const std::vector<std::uint32_t>& atoms,
                     const std::vector<Placement>& placements, Representation representation,
                     double lattice) {
  const double placed = lattice * placedAtomCount(molecule, atoms, placements);
  const double apart = bytesPerAtom(representation) * placed;
  if (!drawsQuadrics(representation)) return apart;
  std::vector<Placement> once;
  for (const std::vector<std::uint32_t>& alike : alikePlacements(placements))
    once.push_back(placements[alike.front()]);
  // The place itself, which several lists repeat, and the clusters in it; ids of lines.
  constexpr double kPerCopy = 1000, kPerPlacedAtom = 10;
  return std::min(apart, bytesPerAtom(representation) * placedAtomCount(molecule, atoms, once) +
                             kPerCopy * lattice * static_cast<double>(placements.size()) +
                             kPerPlacedAtom * placed);
}

// Copies are cheap to ask for, and a system short of memory ends the process without a word.
void requireMemory(const std::string& file, double atoms, double placed, double bytes) {
  const double available = static_cast<double>(physicalMemoryBytes());
  if (available == 0 || bytes <= available) return;
  throw InputError(
      fmt::format("'{}': {:.0f} copies of {:.0f} atoms take {:.0f} GB of memory, more than there is; draw "
                  "fewer copies or a part (--select)",
                  file, placed / atoms, atoms, bytes / 1e9));
}

void requireIds(const std::string& file, double atoms, double placed) {
  constexpr double kMost = 4294967294;
  if (placed <= kMost) return;
  throw InputError(fmt::format(
      "'{}': {:.0f} copies of {:.0f} atoms are more than the 4,294,967,294 atoms that can be told "
      "apart; draw fewer copies or a part (--select)",
      file, placed / atoms, atoms));
}

Preparation structurePictures(const std::string& file, std::string bytes, const RenderOptions& options) {
  if (!options.panels.empty()) return picturesWithPanels(file, bytes, options);
  return StructurePictures(file, options).make(readFor(options.structure, file, std::move(bytes)));
}

}  // namespace meniscus

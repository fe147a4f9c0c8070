// `meniscus render`: structure files -> pictures. Files are read one after the other; the OpenGL context is
// made when the first picture is ready to be drawn, so that what is wrong with an input or an output is said
// without waiting for it.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <memory>
#include <new>
#include <set>
#include <utility>

#include "app/commands.h"
#include "app/output_name.h"
#include "app/progress.h"
#include "app/render_options.h"
#include "app/run_report.h"
#include "core/bonds.h"
#include "core/camera_fit.h"
#include "core/displacement.h"
#include "core/error.h"
#include "core/mesh/surface_mesh.h"
#include "core/primitives.h"
#include "io/image_writer.h"
#include "io/mesh_file.h"
#include "io/output_file.h"
#include "render/renderer.h"

namespace meniscus {
namespace {

using Molecules = std::vector<std::shared_ptr<const Molecule>>;
using Objects = std::vector<SceneObject>;

/// Passes rows on and counts the time that takes.
class TimedSink : public RowSink {
 public:
  TimedSink(RowSink& sink, double& seconds) : sink_(sink), seconds_(seconds) {}
  void writeRows(std::span<const std::byte> rows) override {
    const Timed timed(seconds_);
    sink_.writeRows(rows);
  }

 private:
  RowSink& sink_;
  double& seconds_;
};

class RenderRun {
 public:
  explicit RenderRun(const RenderOptions& options)
      : options_(options),
        pattern_(options.output.empty() ? options.exportMesh : options.output),
        exportPattern_(options.exportMesh),
        progress_(!options.quiet) {
    report_.size = options.size;
    report_.samples = options.samples;
  }
  int run();

 private:
  void checkBeforeReading() const;
  void renderFile(const std::string& file);
  Molecules readMolecules(const std::string& file);
  void showNotes(const std::string& file, const Logger& logger);
  void requireMemory(const std::string& file, const Molecules& molecules) const;
  bool draws(Representation representation) const;
  bool drawsBonds() const;
  SceneObject objectFor(std::shared_ptr<const Molecule> molecule) const;
  Objects objectsFor(const std::string& file, const std::shared_ptr<const Molecule>& molecule) const;
  Camera cameraFor(const std::string& file, const std::vector<Objects>& models) const;
  void drawPicture(const std::string& file, int model, Scene scene);
  void exportMesh(const std::string& output, const Primitives& primitives);
  ImageFileOptions imageOptionsFor(const std::string& file, const std::string& output,
                                   const Scene& scene) const;
  Renderer& renderer();
  void finishReport();

  const RenderOptions& options_;
  OutputPattern pattern_;  // of pictures, or of meshes if there are none
  OutputPattern exportPattern_;
  Progress progress_;
  RunReport report_;
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
};

int RenderRun::run() {
  checkBeforeReading();
  for (const std::string& file : options_.files) {
    try {
      renderFile(file);
    } catch (const GraphicsError&) {
      throw;
    } catch (const Error& error) {
      if (options_.files.size() == 1) throw;
      report_.failures.push_back(error.what());
    } catch (const std::bad_alloc&) {
      if (options_.files.size() == 1) throw;
      report_.failures.push_back("'" + file + "': not enough memory; draw fewer atoms or a smaller picture");
    }
  }
  progress_.clear();
  finishReport();
  for (const std::string& failure : report_.failures) std::fprintf(stderr, "meniscus: %s\n", failure.c_str());
  if (report_.failures.size() > 1)
    std::fprintf(stderr, "meniscus: %zu of %zu files failed\n", report_.failures.size(),
                 options_.files.size());
  return static_cast<int>(report_.failures.empty() ? ExitCode::ok : ExitCode::badInput);
}

// What is wrong whatever the files hold.
void RenderRun::checkBeforeReading() const {
  requireDistinctOutputs(pattern_, options_.files);
  std::vector<std::pair<const char*, std::string>> selections{{"--select", options_.structure.select},
                                                              {"--focus", options_.focus}};
  for (const ShownApart& shown : options_.shown) selections.emplace_back("--show", shown.cid);
  for (const auto& [option, cid] : selections) {
    try {
      if (!cid.empty()) selectAtoms(Molecule{}, cid);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", option, error.what()));
    }
  }
  if (!options_.exportMesh.empty()) {
    requireDistinctOutputs(exportPattern_, options_.files);
    if (exportPattern_.namesModel() != pattern_.namesModel())
      throw UsageError(
          "--export: put {model} into the names of the picture and of the mesh, or into neither");
    if (!draws(Representation::surface))
      throw UsageError("--export: nothing is drawn as a surface; add --representation surface");
  }
  if (!pattern_.namesModel()) {
    for (const std::string& file : options_.files) {
      requireWritable(pattern_.nameFor(file, 1));
      if (!options_.exportMesh.empty()) requireWritable(exportPattern_.nameFor(file, 1));
    }
  }
  if (!options_.statsFile.empty()) requireWritable(options_.statsFile);
}

void RenderRun::renderFile(const std::string& file) {
  const Molecules molecules = readMolecules(file);
  requireMemory(file, molecules);
  std::vector<Objects> models;
  for (const auto& molecule : molecules) models.push_back(objectsFor(file, molecule));
  Scene scene;
  scene.background = options_.background;
  scene.camera = cameraFor(file, models);

  if (!pattern_.namesModel()) {
    for (Objects& objects : models)
      std::move(objects.begin(), objects.end(), std::back_inserter(scene.objects));
    drawPicture(file, molecules.front()->model, std::move(scene));
    return;
  }
  std::set<std::string> outputs;
  for (const auto& molecule : molecules) outputs.insert(pattern_.nameFor(file, molecule->model));
  if (outputs.size() < molecules.size())
    throw InputError(
        fmt::format("'{}': has several models of the same number, so {{model}} cannot tell them apart; "
                    "choose one with --model",
                    file));
  for (Objects& objects : models) {
    const int model = objects.front().molecule->model;
    scene.objects = std::move(objects);
    drawPicture(file, model, scene);
  }
}

Molecules RenderRun::readMolecules(const std::string& file) {
  Logger logger;
  StructureFile structure;
  {
    const Timed timed(report_.parseSeconds);
    structure = readStructure(file, options_.structure, logger);
  }
  Molecules molecules;
  for (Molecule& molecule : structure.models) {
    if (drawsBonds()) {
      const Timed timed(report_.bondsSeconds);
      addMissingBonds(molecule, logger);
    }
    if (draws(Representation::ellipsoids)) noteOddDisplacements(molecule, logger);
    molecules.push_back(std::make_shared<const Molecule>(std::move(molecule)));
  }
  showNotes(file, logger);
  return molecules;
}

void RenderRun::showNotes(const std::string& file, const Logger& logger) {
  constexpr std::size_t kMostNotes = 5;
  if (options_.quiet) return;
  progress_.clear();
  const std::vector<std::string>& notes = logger.notes();
  for (std::size_t i = 0; i < notes.size() && i < kMostNotes; ++i)
    std::fprintf(stderr, "meniscus: %s: note: %s\n", file.c_str(), notes[i].c_str());
  if (notes.size() > kMostNotes)
    std::fprintf(stderr, "meniscus: %s: note: ... and %zu more (meniscus info %s shows all)\n", file.c_str(),
                 notes.size() - kMostNotes, file.c_str());
}

// Copies are cheap to ask for, and a system short of memory ends the process without a word.
void RenderRun::requireMemory(const std::string& file, const Molecules& molecules) const {
  constexpr double kBytesPerAtom = 100;  // measured for spheres alone, 12 million atoms; with bonds it is 190
  const double available = static_cast<double>(physicalMemoryBytes());
  const glm::dvec3 copies(options_.replicate);
  double atoms = 0;
  for (const auto& molecule : molecules) atoms += static_cast<double>(molecule->atomCount());
  const double needed = kBytesPerAtom * atoms * copies.x * copies.y * copies.z;
  if (available == 0 || needed <= available) return;
  throw InputError(
      fmt::format("'{}': {:.0f} copies of {:.0f} atoms take {:.0f} GB of memory, more than there is; draw "
                  "fewer copies or a part (--select)",
                  file, copies.x * copies.y * copies.z, atoms, needed / 1e9));
}

SceneObject RenderRun::objectFor(std::shared_ptr<const Molecule> molecule) const {
  SceneObject object;
  object.placements =
      options_.assembly.empty() ? placeOnce(*molecule) : placeAssembly(*molecule, options_.assembly);
  if (options_.replicate != glm::ivec3(1))
    object.placements = replicate(*molecule, object.placements, options_.replicate);
  object.molecule = std::move(molecule);
  object.representation = options_.representation;
  object.coloring = options_.coloring;
  object.radii = options_.radii;
  object.ballScale = options_.ballScale.value_or(object.ballScale);
  object.stickRadius = options_.stickRadius.value_or(object.stickRadius);
  object.licoriceRadius = options_.stickRadius.value_or(object.licoriceRadius);
  object.ellipsoidStickRadius = options_.stickRadius.value_or(object.ellipsoidStickRadius);
  object.probability = options_.probability;
  object.surface = options_.surfaceShape;
  return object;
}

bool RenderRun::draws(Representation representation) const {
  return options_.representation == representation ||
         std::any_of(options_.shown.begin(), options_.shown.end(),
                     [&](const ShownApart& shown) { return shown.representation == representation; });
}

bool RenderRun::drawsBonds() const {
  return needsBonds(options_.representation) ||
         std::any_of(options_.shown.begin(), options_.shown.end(),
                     [&](const ShownApart& shown) { return needsBonds(shown.representation); });
}

// The molecule in its representation, but for the atoms that --show draws in one of their own.
Objects RenderRun::objectsFor(const std::string& file,
                              const std::shared_ptr<const Molecule>& molecule) const {
  const SceneObject whole = objectFor(molecule);
  if (options_.shown.empty()) return {whole};
  std::vector<std::size_t> owner(molecule->atomCount(), 0);
  for (std::size_t i = 0; i < options_.shown.size(); ++i) {
    const std::vector<std::uint32_t> atoms = selectAtoms(*molecule, options_.shown[i].cid);
    if (atoms.empty())
      throw InputError(
          fmt::format("'{}': --show '{}' matches none of the atoms that are drawn; see meniscus info", file,
                      options_.shown[i].cid));
    for (const std::uint32_t atom : atoms) owner[atom] = i + 1;
  }
  Objects objects(options_.shown.size() + 1, whole);
  for (std::size_t i = 0; i < options_.shown.size(); ++i) {
    objects[i + 1].representation = options_.shown[i].representation;
    if (options_.shown[i].coloring) objects[i + 1].coloring = *options_.shown[i].coloring;
  }
  for (std::uint32_t atom = 0; atom < owner.size(); ++atom) objects[owner[atom]].atoms.push_back(atom);
  std::erase_if(objects, [](const SceneObject& object) { return object.atoms.empty(); });
  return objects;
}

// One camera for all models of a file, so that they can be compared and make a film; it looks as suits the
// first.
Camera RenderRun::cameraFor(const std::string& file, const std::vector<Objects>& models) const {
  std::vector<FitSphere> spheres, first;
  for (const Objects& objects : models) {
    for (const SceneObject& object : objects) {
      if (&objects == &models.front()) {
        const std::vector<FitSphere> some = fitSpheres(object);
        first.insert(first.end(), some.begin(), some.end());
      }
      std::vector<std::uint32_t> atoms;
      if (!options_.focus.empty()) {
        atoms = selectAtoms(*object.molecule, options_.focus);
        if (atoms.empty()) continue;
      }
      const std::vector<FitSphere> some = fitSpheres(object, atoms);
      spheres.insert(spheres.end(), some.begin(), some.end());
    }
  }
  if (spheres.empty())
    throw InputError(
        fmt::format("'{}': --focus '{}' matches none of the atoms that are drawn; see meniscus info", file,
                    options_.focus));

  Camera camera;
  camera.projection = options_.orthographic ? Projection::orthographic : Projection::perspective;
  camera.fovY = glm::radians(options_.fovYDeg);
  camera.zoom = options_.zoom;
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
  return fitted(camera, options_.size, spheres);
}

// Of each object that is drawn so, in the order of the scene.
void RenderRun::exportMesh(const std::string& output, const Primitives& primitives) {
  const Timed timed(report_.meshSeconds);
  MeshOptions mesh;
  mesh.spacing = options_.meshSpacing.value_or(mesh.spacing);
  std::vector<SurfaceMesh> surfaces;
  std::size_t triangles = 0;
  for (const MetaballField& field : primitives.surfaces) {
    surfaces.push_back(meshSurface(field, mesh));
    triangles += surfaces.back().triangles.size();
  }
  if (triangles == 0)
    throw InputError(
        fmt::format("cannot write '{}': the field nowhere reaches the level, so there is no "
                    "surface; give a smaller --level or --mesh-spacing",
                    output));
  writeMeshFile(output, surfaces, primitives.origin);
}

void RenderRun::drawPicture(const std::string& file, int model, Scene scene) {
  const std::string output = options_.output.empty() ? "" : pattern_.nameFor(file, model);
  PictureReport picture;
  picture.input = file;
  picture.output = output;
  const Molecule* counted = nullptr;
  for (const SceneObject& object : scene.objects) {
    if (object.molecule.get() == counted) continue;
    counted = object.molecule.get();
    picture.atoms += counted->atomCount();
    picture.bonds += counted->bonds.size();
  }
  ImageFileOptions imageOptions;
  std::unique_ptr<ImageFile> image;
  if (!output.empty()) {
    imageOptions = imageOptionsFor(file, output, scene);
    image = ImageFile::create(output, imageOptions);
  }
  std::shared_ptr<const Primitives> primitives;
  {
    const Timed timed(report_.primitivesSeconds);
    primitives = std::make_shared<const Primitives>(buildPrimitives(scene, options_.lines.groups));
    scene.objects.clear();
  }
  picture.spheres = primitives->spheres.size();
  picture.cylinders = primitives->cylinders.size();
  picture.ellipsoids = primitives->ellipsoids.size();
  for (const MetaballField& field : primitives->surfaces) picture.metaballs += field.balls.size();

  if (!options_.exportMesh.empty()) exportMesh(exportPattern_.nameFor(file, model), *primitives);
  if (output.empty()) return;

  const View view = makeView(scene.camera, options_.size, primitives->bounds());
  RenderSettings settings;
  settings.samples = options_.samples;
  settings.shadows = options_.shadows;
  settings.occlusion = options_.occlusion;
  if (settings.occlusion.on) scene.lighting = ambientLighting();
  Lighting& light = scene.lighting;
  light.key.intensity = options_.keyLight.value_or(light.key.intensity);
  light.fill.intensity = options_.fillLight.value_or(light.fill.intensity);
  light.ambient = options_.ambientLight.value_or(light.ambient);
  light.specular = options_.highlight.value_or(light.specular);
  settings.lines = options_.lines;
  settings.depthUnsharp = options_.depthUnsharp;
  settings.fog = options_.fog;
  settings.surface = options_.surface;
  settings.quadrics = options_.quadrics;
  progress_.start(fmt::format("{} -> {}", file, output));
  Renderer& draw = renderer();
  draw.setPrimitives(std::move(primitives));
  TimedSink sink(*image, report_.encodeSeconds);
  draw.renderPicture(view, scene.lighting, scene.background, settings,
                     {imageOptions.format, imageOptions.layers}, sink,
                     [this](double share) { progress_.update(share); });
  {
    const Timed timed(report_.encodeSeconds);
    image->finish();
  }
  report_.pictures.push_back(std::move(picture));
}

ImageFileOptions RenderRun::imageOptionsFor(const std::string& file, const std::string& output,
                                            const Scene& scene) const {
  constexpr std::size_t kExactInFloat = std::size_t{1} << 24;
  ImageFileOptions image;
  image.size = options_.size;
  image.format = imageTypeOf(output) == ImageType::exr ? PixelFormat::rgbaFloat
                 : options_.bitDepth == 16             ? PixelFormat::rgba16
                                                       : PixelFormat::rgba8;
  image.alpha = options_.background.transparent;
  image.layers = options_.layers;
  image.wideIds = countIds(scene) > kExactInFloat;
  image.dpi = options_.dpi;
  // The names of folders and of the output are left out: they say nothing about the picture, and the same
  // picture should be the same bytes wherever it is made.
  const std::string input = std::filesystem::path(file).filename().string();
  image.metadata = {{"Software", std::string("Meniscus ") + version()},
                    {"Source", input},
                    {"Comment", "meniscus render " + input + options_.pictureOptions}};
  return image;
}

Renderer& RenderRun::renderer() {
  if (renderer_ != nullptr) return *renderer_;
  const Timed timed(report_.contextSeconds);
  context_ = Context::create(options_.backend);
  RendererOptions rendererOptions;
  rendererOptions.shaderDir = options_.shaderDir;
  rendererOptions.timePasses = options_.explain;
  renderer_ = std::make_unique<Renderer>(rendererOptions);
  return *renderer_;
}

void RenderRun::finishReport() {
  if (!options_.explain && options_.statsFile.empty()) return;
  if (renderer_ != nullptr) {
    report_.backend = context_->name();
    report_.renderer = context_->rendererName();
    report_.render = renderer_->stats();
  }
  addProcessUsage(report_);
  if (options_.explain) std::fputs(explanationOf(report_).c_str(), stdout);
  if (!options_.statsFile.empty()) writeTextFile(options_.statsFile, statsAsJson(report_));
}

}  // namespace

int runRender(const std::vector<std::string>& arguments) {
  const std::optional<RenderOptions> options = parseRenderOptions(arguments);
  return options ? RenderRun(*options).run() : 0;
}

}  // namespace meniscus

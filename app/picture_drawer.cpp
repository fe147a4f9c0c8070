#include "app/picture_drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/commands.h"
#include "app/error_panel.h"
#include "app/label_text.h"
#include "app/structure_pictures.h"
#include "core/buffer_sink.h"
#include "core/error.h"
#include "core/mesh/surface_mesh.h"
#include "core/primitives.h"
#include "io/environment_file.h"
#include "io/image_writer.h"
#include "io/mesh_file.h"

namespace meniscus {
namespace {

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

PictureReport reportOn(const Picture& picture, const Primitives& primitives) {
  PictureReport report;
  report.input = picture.input;
  report.output = picture.output;
  report.size = picture.options.size;
  report.samples = picture.options.samples;
  const Molecule* counted = nullptr;
  for (const SceneObject& object : picture.scene.objects) {
    if (object.molecule.get() == counted) continue;
    counted = object.molecule.get();
    report.atoms += counted->atomCount();
    report.bonds += counted->bonds.size();
  }
  const QuadricCounts all = primitives.counts();
  report.spheres = all.spheres;
  report.cylinders = all.cylinders;
  report.ellipsoids = all.ellipsoids;
  for (const QuadricUnit& unit : primitives.units) report.copies += unit.copies.size();
  report.quadricBytes = primitives.quadricBytes();
  report.triangles = primitives.mesh.triangles.size();
  for (const MetaballField& field : primitives.surfaces) report.metaballs += field.balls.size();
  return report;
}

// What another panel draws of the same atoms.
void addPrimitives(const PictureReport& panel, PictureReport& report) {
  report.spheres += panel.spheres;
  report.cylinders += panel.cylinders;
  report.ellipsoids += panel.ellipsoids;
  report.triangles += panel.triangles;
  report.metaballs += panel.metaballs;
  report.copies += panel.copies;
  report.quadricBytes += panel.quadricBytes;
}

// Where every copy's quadrics are needed by themselves. input: of so many atoms.
void requireMemoryForCopies(const std::string& input, std::size_t atoms, const QuadricCounts& placed) {
  const auto drawn = static_cast<double>(placed.spheres + placed.ellipsoids);
  const double bytes = drawn * bytesPerAtom(placed.ellipsoids > 0  ? Representation::ellipsoids
                                            : placed.cylinders > 0 ? Representation::licorice
                                                                   : Representation::spacefill);
  requireMemory(input, static_cast<double>(atoms), drawn, bytes);
}

std::size_t bytesOf(ImageSize size) {
  return std::size_t{4} * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

// Panels are put together in memory, unlike other pictures, which are written row by row.
void requireMemoryForPanels(const Picture& picture) {
  const std::size_t available = physicalMemoryBytes(), wanted = 2 * bytesOf(picture.options.size);
  if (available > 0 && wanted > available)
    throw InputError(
        fmt::format("cannot write '{}': panels of {}x{} pixels take {:.0f} GB of memory, more than there is; "
                    "give a smaller --size",
                    picture.output, picture.options.size.width, picture.options.size.height,
                    static_cast<double>(wanted) / 1e9));
}

ImageFileOptions imageOptionsFor(const Picture& picture) {
  constexpr std::size_t kExactInFloat = std::size_t{1} << 24;
  const RenderOptions& options = picture.options;
  ImageFileOptions image;
  image.size = options.size;
  image.format = imageTypeOf(picture.output) == ImageType::exr ? PixelFormat::rgbaFloat
                 : options.bitDepth == 16                      ? PixelFormat::rgba16
                                                               : PixelFormat::rgba8;
  image.alpha = picture.scene.background.transparent;
  image.layers = options.layers;
  image.wideIds = countIds(picture.scene) > kExactInFloat;
  image.dpi = options.dpi;
  image.metadata = {{"Software", std::string("Meniscus ") + version()},
                    {"Source", picture.source},
                    {"Comment", picture.command}};
  return image;
}

void writeLabel(const std::string& text, double letters, const RenderOptions& options,
                const PanelPlace& place, PanelCanvas& canvas) {
  for (const LabelSprite& sprite : drawLabels({{text, {}, 0}}, letters, options.labelFont))
    canvas.write(place, sprite, options.labelColors);
}

}  // namespace

RenderSettings renderSettingsOf(const RenderOptions& options) {
  RenderSettings settings;
  settings.samples = options.samples;
  settings.shadows = options.shadows;
  settings.occlusion = options.occlusion;
  settings.trace = options.trace;
  // What is traced is on.
  if (options.trace.shadows > 0 && options.shadows.mode == ShadowMode::off)
    settings.shadows.mode = ShadowMode::soft;
  settings.occlusion.on = options.occlusion.on || options.trace.occlusion > 0;
  settings.lines = options.lines;
  settings.depthUnsharp = options.depthUnsharp;
  settings.fog = options.fog;
  settings.surface = options.surface;
  settings.quadrics = options.quadrics;
  settings.levelOfDetail = options.levelOfDetail;
  return settings;
}

Lighting lightOf(const RenderOptions& options) {
  Lighting light = renderSettingsOf(options).occlusion.on ? ambientLighting() : Lighting{};
  light.key.intensity = options.keyLight.value_or(light.key.intensity);
  light.key.direction = options.keyDirection.value_or(light.key.direction);
  light.fill.intensity = options.fillLight.value_or(light.fill.intensity);
  light.ambient = options.ambientLight.value_or(light.ambient);
  light.specular = options.highlight.value_or(light.specular);
  return light;
}

// Those that are there already, of the picture before, serve again.
void PictureDrawer::readEnvironments(const Picture& picture) {
  Environments needed;
  const auto need = [&](const std::filesystem::path& file) {
    if (file.empty() || needed.contains(file)) return;
    const auto known = environments_.find(file);
    needed[file] = known != environments_.end() ? known->second : readEnvironment(file);
  };
  need(picture.options.environmentFile);
  for (const Picture& panel : picture.panels) need(panel.options.environmentFile);
  environments_ = std::move(needed);
}

void PictureDrawer::draw(Picture picture) {
  readEnvironments(picture);
  ImageFileOptions imageOptions;
  std::unique_ptr<ImageFile> image;
  if (!picture.output.empty()) {
    imageOptions = imageOptionsFor(picture);
    image = ImageFile::create(picture.output, imageOptions);
  }
  exportMesh(picture);
  if (!image) return;
  TimedSink sink(*image, report_.encodeSeconds);
  PictureReport report = render(picture, sink, {imageOptions.format, imageOptions.layers},
                                fmt::format("{} -> {}", picture.input, picture.output));
  {
    const Timed timed(report_.encodeSeconds);
    image->finish();
  }
  report_.pictures.push_back(std::move(report));
}

// Of each object that is drawn so, in the order of the scene.
void PictureDrawer::exportMesh(Picture& picture) {
  if (picture.exported.empty()) return;
  if (!picture.primitives) picture.primitives = primitivesOf(picture);
  const Timed timed(report_.meshSeconds);
  MeshOptions mesh;
  mesh.spacing = picture.options.meshSpacing.value_or(mesh.spacing);
  std::vector<SurfaceMesh> surfaces;
  std::size_t triangles = 0;
  for (const MetaballField& field : picture.primitives->surfaces) {
    surfaces.push_back(meshSurface(field, mesh));
    triangles += surfaces.back().triangles.size();
  }
  if (triangles == 0)
    throw InputError(
        fmt::format("cannot write '{}': the field nowhere reaches the level, so there is no "
                    "surface; give a smaller --level or --mesh-spacing",
                    picture.exported));
  writeMeshFile(picture.exported, surfaces, picture.primitives->origin);
}

void PictureDrawer::drawTo(Picture picture, RowSink& sink, const std::string& label) {
  readEnvironments(picture);
  exportMesh(picture);
  TimedSink timed(sink, report_.encodeSeconds);
  report_.pictures.push_back(render(picture, timed, {PixelFormat::rgba8}, label));
}

PictureReport PictureDrawer::render(Picture& picture, RowSink& sink, const PixelLayout& layout,
                                    const std::string& label) {
  if (!picture.panels.empty()) return renderPanels(picture, sink, label);
  const RenderOptions& options = picture.options;
  Scene& scene = picture.scene;
  std::shared_ptr<const Primitives> primitives =
      picture.primitives ? picture.primitives : primitivesOf(picture);
  PictureReport report = reportOn(picture, *primitives);
  report_.size = report.size;
  report_.samples = report.samples;
  scene.objects.clear();

  const View view = makeView(scene.camera, options.size, primitives->bounds());
  std::vector<LabelSprite> labels = drawLabels(
      scene.labels, std::max(0.01 * options.labelSize * options.size.height, 1.0), options.labelFont);
  RenderSettings settings = renderSettingsOf(options);
  if (!options.environmentFile.empty())
    settings.trace.environmentMap = environments_.at(options.environmentFile);
  progress_.start(label);
  Renderer& draw = renderer();
  draw.setCopyGuard([input = report.input, atoms = report.atoms](const QuadricCounts& placed) {
    requireMemoryForCopies(input, atoms, placed);
  });
  show(std::move(primitives));
  draw.setLabels(std::move(labels), options.labelColors);
  draw.setPreview(layout.format == PixelFormat::rgba8 ? preview : PicturePreview{});
  draw.renderPicture(view, lightOf(options), scene.background, settings, layout, sink, [this](double share) {
    if (watch) watch();
    progress_.update(share);
  });
  return report;
}

// How far the second panel is from the first, along the rays of the first one's camera through the pixels'
// centres.
void PictureDrawer::renderErrors(const Picture& picture, const PanelPlace& place, PanelCanvas& canvas) {
  const Picture &first = picture.panels[0], &second = picture.panels[1];
  const Camera camera = seenBy(picture.scene.camera, first.scene.camera);
  const HitChannels distances{true, false, false};
  const HitImage truth = cast(first, camera, place.picture, distances),
                 compared = cast(second, camera, place.picture, distances);
  drawErrorPanel(drawErrors(compared, truth, first.scene.background), picture.options, place, canvas);
}

// One after the other, by the camera of the whole.
PictureReport PictureDrawer::renderPanels(Picture& picture, RowSink& sink, const std::string& label) {
  const RenderOptions& options = picture.options;
  const std::vector<PanelPlace> places = placePanels(picture.panels.size(), options.size, options.divider);
  requireMemoryForPanels(picture);
  const bool compared = std::any_of(options.panels.begin(), options.panels.end(),
                                    [](const PanelOptions& panel) { return panel.error; });
  for (std::size_t i = 0; compared && i < 2; ++i)
    if (!picture.panels[i].primitives) picture.panels[i].primitives = primitivesOf(picture.panels[i]);
  const double letters = std::max(0.01 * options.labelSize * options.size.height, 1.0);
  PanelCanvas canvas(options.size);
  PictureReport report;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string& text = options.panels[i].label;
    if (options.panels[i].error) {
      renderErrors(picture, places[i], canvas);
      writeLabel(text, letters, options, places[i], canvas);
      continue;
    }
    Picture& panel = picture.panels[i];
    panel.options.size = places[i].picture;
    panel.scene.camera = seenBy(picture.scene.camera, panel.scene.camera);
    std::vector<std::byte> bytes;
    bytes.reserve(bytesOf(places[i].picture));
    BufferSink buffer(bytes);
    PictureReport own = render(panel, buffer, {PixelFormat::rgba8}, label);
    canvas.paste(places[i], bytes);
    writeLabel(text, letters, options, places[i], canvas);
    if (i == 0)
      report = std::move(own);
    else
      addPrimitives(own, report);
  }
  sink.writeRows(canvas.bytes());
  report.output = picture.output;
  report.size = report_.size = options.size;
  return report;
}

HitImage PictureDrawer::hits(const Picture& picture) {
  return cast(picture, picture.scene.camera, picture.options.size, {false, false, true});
}

HitImage PictureDrawer::cast(const Picture& picture, const Camera& camera, ImageSize size,
                             const HitChannels& channels) {
  show(picture.primitives);
  return renderer().renderHits(makeView(camera, size, shown_->bounds()), channels, picture.options.surface,
                               picture.options.quadrics);
}

RenderStats PictureDrawer::takeStats() {
  RenderStats stats = renderer().stats();
  renderer().forgetStats();
  return stats;
}

void PictureDrawer::show(std::shared_ptr<const Primitives> primitives) {
  if (primitives == shown_) return;
  shown_.reset();
  renderer().setPrimitives(primitives);
  shown_ = std::move(primitives);
}

std::shared_ptr<const Primitives> PictureDrawer::primitivesOf(const Picture& picture) {
  const Timed timed(report_.primitivesSeconds);
  return std::make_shared<const Primitives>(
      buildPrimitives(picture.scene, picture.options.lines.groups, Copies::shared));
}

Renderer& PictureDrawer::renderer() {
  if (renderer_ != nullptr) return *renderer_;
  const Timed timed(report_.contextSeconds);
  context_ = Context::create(options_.backend);
  RendererOptions rendererOptions;
  rendererOptions.shaderDir = options_.shaderDir;
  rendererOptions.timePasses = options_.explain || !options_.statsFile.empty();
  renderer_ = std::make_unique<Renderer>(rendererOptions);
  return *renderer_;
}

void PictureDrawer::finishReport() {
  if (renderer_ == nullptr) return;
  report_.backend = context_->name();
  report_.renderer = context_->rendererName();
  report_.render = renderer_->stats();
}

}  // namespace meniscus

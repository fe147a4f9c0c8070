#include "app/measure/measure_scene.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <span>
#include <utility>

#include "core/bonds.h"
#include "core/camera_fit.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "io/output_file.h"
#include "io/structure_reader.h"

namespace meniscus::measure {

namespace {

namespace fs = std::filesystem;

SceneObject objectOf(const fs::path& file, const std::string& select, const glm::ivec3& copies,
                     Representation representation) {
  StructureOptions options;
  options.altlocs = Altlocs::first;
  options.waters = Waters::automatic;
  options.select = select;
  Logger logger;
  StructureFile structure = readStructure(file, options, logger);
  Molecule& molecule = structure.models.front();
  if (needsBonds(representation)) addMissingBonds(molecule, logger);
  SceneObject object;
  object.molecule = std::make_shared<const Molecule>(std::move(molecule));
  object.placements = placeOnce(*object.molecule);
  if (copies != glm::ivec3(1)) object.placements = replicate(*object.molecule, object.placements, copies);
  object.representation = representation;
  return object;
}

/// Fowler-Noll-Vo 1a, 64 bits: names files, nothing more.
class Hash {
 public:
  void add(const void* data, std::size_t bytes) {
    for (const auto* p = static_cast<const unsigned char*>(data); bytes > 0; --bytes, ++p)
      value_ = (value_ ^ *p) * 0x100000001B3u;
  }
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    add(&value, sizeof(value));
  }
  template <typename V>
  void addVector(const V& v, int count) {
    for (int i = 0; i < count; ++i) add(v[i]);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

std::uint64_t hashOf(const Primitives& primitives, const View& view) {
  Hash hash;
  hash.add(std::uint32_t{1});  // changes with the meaning of the truth
  hash.addVector(primitives.origin, 3);
  for (const SpherePrimitive& s : primitives.spheres) {
    hash.addVector(s.center, 3);
    hash.add(s.radius);
    hash.add(s.id);
  }
  for (const CylinderPrimitive& c : primitives.cylinders) {
    hash.addVector(c.a, 3);
    hash.addVector(c.b, 3);
    hash.add(c.radius);
    hash.add(c.idA);
    hash.add(c.idB);
  }
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) {
    hash.addVector(e.center, 3);
    hash.addVector(e.axisA, 3);
    hash.addVector(e.axisB, 3);
    hash.add(e.shortest);
    hash.add(e.id);
  }
  for (const MetaballField& field : primitives.surfaces) {
    hash.add(field.kernel.shape);
    hash.add(field.kernel.exponent);
    hash.add(field.level);
    for (const Metaball& b : field.balls) {
      hash.addVector(b.center, 3);
      hash.add(b.support);
      hash.add(b.coefficient);
      hash.add(b.id);
    }
  }
  hash.add(view.projection);
  for (int column = 0; column < 3; ++column) hash.addVector(view.rotation[column], 3);
  hash.addVector(view.pivot, 3);
  for (const double value : {view.distance, view.pixelSize, view.nearZ, view.farZ}) hash.add(value);
  hash.addVector(view.center, 2);
  hash.add(view.size.width);
  hash.add(view.size.height);
  return hash.value();
}

// Magic, number of pixels, counts, then the arrays as they lie in memory: read by the machine that wrote it.
constexpr char kMagic[16] = "meniscus truth1";

template <typename File, typename Image>
bool eachArray(Image& image, const File& handle) {
  return handle(image.hits.distance) && handle(image.hits.normal) && handle(image.hits.id) &&
         handle(image.distance) && handle(image.pieces) && handle(image.grazing);
}

bool readTruth(const fs::path& path, ImageSize size, ReferenceImage& image) {
  std::ifstream file(path, std::ios::binary);
  char magic[sizeof(kMagic)] = {};
  std::uint64_t pixels = 0;
  file.read(magic, sizeof(magic));
  file.read(reinterpret_cast<char*>(&pixels), sizeof(pixels));
  if (!file || std::memcmp(magic, kMagic, sizeof(magic)) != 0 ||
      pixels != static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height))
    return false;
  image.hits.size = size;
  const bool whole = eachArray(image, [&](auto& array) {
    array.resize(pixels);
    const std::size_t bytes = array.size() * sizeof(array[0]);
    file.read(reinterpret_cast<char*>(array.data()), static_cast<std::streamsize>(bytes));
    return static_cast<bool>(file);
  });
  return whole && file.peek() == std::ifstream::traits_type::eof();
}

void writeTruth(const fs::path& path, const ReferenceImage& image) {
  OutputFile file(path);
  const std::uint64_t pixels = image.distance.size();
  file.write({kMagic, sizeof(kMagic)});
  file.write({reinterpret_cast<const char*>(&pixels), sizeof(pixels)});
  eachArray(image, [&](const auto& array) {
    file.write({reinterpret_cast<const char*>(array.data()), array.size() * sizeof(array[0])});
    return true;
  });
  file.commit();
}

}  // namespace

std::shared_ptr<const Primitives> primitivesOf(const SceneSpec& spec, std::uint64_t seed) {
  if (spec.balls > 0) return packedBalls(spec.balls, seed);
  if (!spec.stability.empty()) {
    for (const StabilityRecipe& recipe : stabilityRecipes())
      if (recipe.name == spec.stability) return recipe.make(seed, {64, 48}).surface;
  }
  Scene scene;
  scene.objects = {objectOf(spec.molecule, spec.select, spec.copies, Representation::surface)};
  scene.objects.front().surface = spec.shape;
  return std::make_shared<const Primitives>(buildPrimitives(scene));
}

std::shared_ptr<const Primitives> moleculeAs(const fs::path& file, Representation representation,
                                             const glm::ivec3& copies, bool alsoSurface) {
  Scene scene;
  scene.objects = {objectOf(file, {}, copies, representation)};
  if (alsoSurface) {
    scene.objects.push_back(scene.objects.front());
    scene.objects.back().representation = Representation::surface;
  }
  return std::make_shared<const Primitives>(buildPrimitives(scene));
}

std::size_t ballCount(const Primitives& primitives) {
  std::size_t count = 0;
  for (const MetaballField& field : primitives.surfaces) count += field.balls.size();
  return count > 0 ? count : primitives.spheres.size() + primitives.ellipsoids.size();
}

View viewOf(const Primitives& primitives, const ViewSpec& spec, ImageSize size) {
  std::vector<FitSphere> fit;
  const auto add = [&](const glm::vec3& center, double radius) {
    fit.push_back({primitives.origin + glm::dvec3(center), radius});
  };
  for (const SpherePrimitive& s : primitives.spheres) add(s.center, static_cast<double>(s.radius));
  for (const EllipsoidPrimitive& e : primitives.ellipsoids)
    add(e.center, static_cast<double>(glm::length(e.axisA)));
  for (const MetaballField& field : primitives.surfaces)
    for (const Metaball& ball : field.balls)
      add(ball.center, static_cast<double>(ball.support) *
                           coreShare(field.kernel, field.level, static_cast<double>(ball.coefficient)));
  Camera camera;
  camera.projection = spec.orthographic ? Projection::orthographic : Projection::perspective;
  camera.fovY = glm::radians(spec.fovDeg);
  camera.zoom = spec.zoom;
  camera.orientation = rotatedBy(principalAxes(fit, size.height > size.width), spec.rotateDeg);
  return makeView(fitted(camera, size, fit), size, primitives.bounds());
}

View beside(const View& view) {
  View other = view;
  const double angle = glm::radians(0.1), c = std::cos(angle), s = std::sin(angle);
  other.rotation = glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c) * view.rotation;
  return other;
}

ReferenceImage truthOf(const Primitives& primitives, const View& view, const fs::path& folder) {
  const fs::path path = folder / fmt::format("{:016x}.bin", hashOf(primitives, view));
  ReferenceImage image;
  if (readTruth(path, view.size, image)) return image;
  image = traceScene(primitives, view);
  writeTruth(path, image);
  return image;
}

}  // namespace meniscus::measure

// Steady frames of a structure's atoms: what bench/against/run compares with other programs.
//
//   steady_frames FILE ASSEMBLY plain|effects FRAMES
//
// 1024 x 768, one ray per pixel, turned by 10 degrees from frame to frame; effects: soft shadows and
// silhouettes. Waters are left out. Each frame is read back. Prints "FRAME i wall-seconds processor-seconds".

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <string_view>

#include "bench/bench_scenes.h"
#include "core/assembly.h"
#include "core/camera_fit.h"
#include "io/structure_reader.h"
#include "render/gl/context.h"
#include "render/renderer.h"

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    if (argc != 5) {
      std::fputs("steady_frames FILE ASSEMBLY plain|effects FRAMES\n", stderr);
      return 2;
    }
    Logger logger;
    StructureOptions read;
    read.waters = Waters::off;
    SceneObject object;
    object.molecule =
        std::make_shared<const Molecule>(std::move(readStructure(argv[1], read, logger).models.front()));
    object.placements = placeAssembly(*object.molecule, argv[2]);
    Camera camera;
    camera = fitted(camera, {1024, 768}, fitSpheres(object));
    Scene scene;
    scene.objects = {object};
    const auto primitives = std::make_shared<const Primitives>(buildPrimitives(scene));
    const auto context = Context::create(Backend::automatic);
    Renderer renderer;
    renderer.setPrimitives(primitives);
    RenderSettings settings;
    settings.samples = 1;
    if (std::string_view(argv[3]) == "effects") {
      settings.shadows.mode = ShadowMode::soft;
      settings.lines.silhouettes = true;
    }
    const BoundingSphere bounds = primitives->bounds();
    for (int i = 0; i < std::atoi(argv[4]); ++i) {
      const View view = makeView(camera, {1024, 768}, bounds);
      bench::NullSink sink;
      double wall = 0;
      const double processor = bench::processorMs([&] {
        wall = bench::wallMs(
            [&] { renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink); });
      });
      fmt::print("FRAME {} {:.4f} {:.4f}\n", i, wall / 1e3, processor / 1e3);
      camera.orientation = glm::angleAxis(glm::radians(10.0), glm::dvec3(0, 1, 0)) * camera.orientation;
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "steady_frames: %s\n", error.what());
    return 1;
  }
}

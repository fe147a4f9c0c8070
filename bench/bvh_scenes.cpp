#include "bench/bvh_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "bench/bench_scenes.h"
#include "core/camera_fit.h"
#include "core/generated_scenes.h"
#include "core/random.h"

namespace meniscus::bench {

namespace {

constexpr ImageSize kSize{640, 480};
constexpr double kPi = 3.14159265358979;

class SceneBuilder {
 public:
  explicit SceneBuilder(double level) : primitives_(std::make_shared<Primitives>()) {
    primitives_->surfaces.resize(1);
    primitives_->surfaces[0].kernel = {KernelShape::quartic};
    primitives_->surfaces[0].level = level;
  }
  void add(const glm::dvec3& center, double support) {
    auto& balls = primitives_->surfaces[0].balls;
    balls.push_back({glm::vec3(center), static_cast<float>(support), 1, 0x6FA8DC,
                     static_cast<std::uint32_t>(balls.size() + 1)});
  }
  BvhScene finish(std::string name, const glm::dquat& orientation = {0.8, 0.2, -0.5, 0.2}) {
    const View view = viewOfAll(*primitives_, kSize, 0.5, Projection::perspective, orientation);
    return {std::move(name), std::move(primitives_), view};
  }

 private:
  std::shared_ptr<Primitives> primitives_;
};

}  // namespace

BvhScene scattered(std::size_t balls) {
  Random random(1);
  SceneBuilder scene(0.25);
  const double support = 2;
  const double volume = static_cast<double>(balls) * 4 / 3 * kPi * support * support * support / 0.5;
  for (std::size_t i = 0; i < balls; ++i) scene.add(random.inBox(0.5 * std::cbrt(volume)), support);
  return scene.finish("scattered");
}

BvhScene tornado(std::size_t balls) {
  Random random(2);
  SceneBuilder scene(0.6);
  // Height 100, radius 6 below and 40 above; five arms with gaps between.
  const double support = 100 / std::cbrt(static_cast<double>(balls)) * 0.9;
  for (std::size_t i = 0; i < balls; ++i) {
    const double share = std::pow(random.uniform(0, 1), 0.7), height = 100 * share;
    const double arm = std::floor(random.uniform(0, 5)) / 5;
    const double turn = 2 * kPi * (arm + 1.5 * share) + 0.5 * random.uniform(-1, 1);
    const double radius = (6 + 34 * share * share) * (1 + 0.12 * random.uniform(-1, 1));
    scene.add({radius * std::cos(turn), height - 50, radius * std::sin(turn)}, support);
  }
  return scene.finish("tornado", {0.97, 0.2, 0.1, 0});
}

BvhScene moleculeOf(std::size_t atoms) {
  SceneSource source;
  source.file = "2hhb.pdb.gz";
  source.representation = Representation::surface;
  source.copies = {2, 1, 1};
  auto primitives = std::make_shared<Primitives>(*loadScene(source, kSize).primitives);
  auto& balls = primitives->surfaces.at(0).balls;
  balls.resize(std::min(balls.size(), atoms));
  const View view = viewOfAll(*primitives, kSize);
  return {"molecule", std::move(primitives), view};
}

BvhScene pool(std::size_t balls) {
  Random random(3);
  SceneBuilder scene(8);
  // 50 x 50, waves of 1.5 around a depth that the density asks for.
  const double spacing = std::cbrt(50.0 * 50 * 8 / static_cast<double>(balls));
  const double support = spacing * std::cbrt(60 * 3 / (4 * kPi));
  for (std::size_t i = 0; i < balls; ++i) {
    const double x = random.uniform(-25, 25), z = random.uniform(-25, 25);
    const double top = 1.5 * std::sin(0.35 * x) * std::cos(0.28 * z + 0.1 * x);
    scene.add({x, random.uniform(-8, top), z}, support);
  }
  return scene.finish("pool", {0.85, 0.45, 0.2, 0.1});
}

}  // namespace meniscus::bench

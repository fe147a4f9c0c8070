#pragma once
// Small scenes with known contents.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image.h"
#include "core/primitives.h"
#include "core/render_settings.h"
#include "core/view.h"

namespace meniscus::test {

/// `count` spheres of radius 1 to 2 Å in a ball, about as dense as a protein; the same for the same seed.
std::shared_ptr<Primitives> randomSpheres(int count, unsigned seed);

/// The same as balls of a quarter of the radius, joined in a chain by cylinders.
std::shared_ptr<Primitives> randomChain(int count, unsigned seed);

/// Ellipsoids instead of the spheres: semi-axes of `share` to 1 of the radius, turned at random. share 1:
/// the same balls.
std::shared_ptr<Primitives> randomEllipsoids(int count, unsigned seed, double share);

/// Looks at all of it from a direction that is no axis.
View viewOf(const Primitives& primitives, ImageSize size, Projection projection = Projection::perspective,
            double fovY = 0.5);

/// Everything off but the number of rays per pixel.
inline RenderSettings withSamples(int samples, QuadricMethod quadrics = QuadricMethod::automatic) {
  RenderSettings settings;
  settings.samples = samples;
  settings.quadrics = quadrics;
  return settings;
}

/// Collects a picture.
class MemorySink : public RowSink {
 public:
  void writeRows(std::span<const std::byte> rows) override {
    bytes.insert(bytes.end(), rows.begin(), rows.end());
  }
  std::vector<std::byte> bytes;
};

/// What the ray through a pixel's centre meets first, by brute force in extended precision.
struct ExactHit {
  std::uint32_t id = 0;  ///< 0 = background
  double distance = 0;   ///< along the unit ray [Å]
  double runnerUp = 0;   ///< distance of the next thing met, if another id; infinity if none
  double clearance = 0;  ///< how far [Å] the ray is from grazing something that is not behind the hit
};
/// Cylinders and ellipsoids count as grazed where one larger or smaller by `margin` [Å] decides otherwise.
ExactHit exactHit(const Primitives& primitives, const View& view, glm::dvec2 pixel, double margin = 1e-4);

}  // namespace meniscus::test

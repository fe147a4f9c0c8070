#pragma once
// Ambient occlusion by casting rays in double precision: what the renderer's is compared with.

#include <cstddef>
#include <vector>

#include "core/primitives.h"
#include "core/view.h"
#include "render/renderer.h"

namespace meniscus::test {

/// A pixel that shows a surface, and what it should show.
struct OcclusionPlace {
  int x = 0, y = 0;                              ///< y from below
  glm::dvec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< view space
  double open = 1;                               ///< share of the sky, weighted by the cosine to the normal
};

/// `count` pixels at random (fewer if the picture is nearly empty) of a scene of spheres, with side * side
/// stratified rays each. Occluders count as OcclusionSettings::radius says.
std::vector<OcclusionPlace> occlusionPlaces(Renderer& renderer, const Primitives& scene, const View& view,
                                            double radius, std::size_t count, int side);

/// How much of an occluder counts at a distance; radius 0: always all of it.
double occluderWeight(double distance, double radius);

struct Deviation {
  double rms = 0, mean = 0, largest = 0;
};
/// Of values, in the order of the places.
Deviation deviationFrom(const std::vector<OcclusionPlace>& places, const std::vector<double>& values);

/// Nothing but ambient light of brightness 1: on white, the picture is the share of the sky.
Lighting ambientOnly();
void whiten(Primitives& scene);

/// A picture of four floats per pixel, rows from the top.
std::vector<float> drawFloats(Renderer& renderer, const View& view, const Lighting& lighting,
                              const RenderSettings& settings);

/// What such a picture shows at the places.
std::vector<double> valuesAt(const std::vector<OcclusionPlace>& places, const std::vector<float>& picture,
                             const View& view);

}  // namespace meniscus::test

#pragma once
// Distances, angles and torsions between points: their values, and what is drawn of them.

#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "core/scene.h"

namespace meniscus {

/// Of two points their distance [Å], of three the angle at the second [degrees, 0..180], of four the torsion
/// about the axis from the second to the third [degrees, -180..180; IUPAC 1974: positive if, seen along the
/// axis, the farther bond is clockwise of the nearer]. NaN where points that coincide or lie in one line
/// leave an angle without meaning.
double measuredValue(std::span<const glm::dvec3> points);

/// "3.82 Å" or "109.5°".
std::string measureText(std::span<const glm::dvec3> points);

/// Adds dashed lines from point to point, and the value as a label.
void addMeasure(std::span<const glm::dvec3> points, Rgb color, Scene& scene);

}  // namespace meniscus

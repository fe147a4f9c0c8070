#pragma once
// A field's balls as one view sees them, computed in double precision: what shaders need to know of where a
// ray passes them, and where on the screen they are.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "core/metaball_field.h"
#include "core/view.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

/// Ball of shaders/include/field.glsl (std430).
struct ProjectedBall {
  glm::vec4 pixel;  ///< projected centre: hi xy, lo xy
  glm::vec4 place;  ///< size of a pixel there or 0; R^2; how far it lies below the plane, hi and lo
  glm::vec4 eye;  ///< from the centre to the eye if rays are taken from there; w: squared radius of its core
  float coefficient;
  float inverseR2;
  std::uint32_t color, id;
};
static_assert(sizeof(ProjectedBall) == 64);

/// FieldUniforms of shaders/include/ball_ray.glsl (std140).
struct FieldBlock {
  glm::vec4
      plane;  ///< z of the plane that places on a ray are measured from; height of the eye above it, hi, lo
  glm::vec4 field;  ///< level; exponent; kernel; 0
};

enum class BallOrder : std::uint8_t {
  depth,    ///< by the depth of their nearest points
  distance  ///< by their effective distance: how far their nearest points are from the eye (orthographic: the
            ///< same as depth)
};

struct ProjectedField {
  /// That reach behind the near plane and into the target; in their order, equals in the field's.
  std::vector<ProjectedBall> balls;
  std::vector<std::uint32_t> indices;  ///< of each: its place in MetaballField::balls
  std::vector<glm::vec4> boxes;        ///< of each: rectangle around it, in pixels of the target
  std::vector<glm::vec4> coreBoxes;    ///< the same around its core; empty (to <= from) if it has none
  /// Of each: its effective distance less the height of the eye above the plane (orthographic: how far its
  /// nearest point lies below the plane) [Å].
  std::vector<double> distances;
  /// Of each: how far its nearest and its farthest point lie below the plane [Å]; positive z is away from the
  /// viewer.
  std::vector<glm::dvec2> depths;
  double nearDepth = 0;  ///< the same of the near plane
  FieldBlock block;
  double reach = 0;  ///< no place on a ray where a ball is met is farther from the plane [Å]
};

/// coreShare() of each ball.
std::vector<float> coreShares(const MetaballField& field);

/// Flags of shaders/include/field.glsl and kernel.glsl.
ShaderFlags kernelFlags(const Kernel& kernel);

/// coreShares: of the field; plane: of a field whose balls were chosen for the target already: all are kept,
/// and this is the z of FieldBlock::plane.
ProjectedField projectField(const MetaballField& field, const std::vector<float>& coreShares,
                            const View& view, const glm::dvec3& origin, const Tile& tile,
                            glm::vec2 sampleShift, BallOrder order, std::optional<double> plane = {});

/// The largest length of a ray per height within a rectangle [pixels of the target, with the sample's shift].
double largestStretch(const View& view, const Tile& tile, const glm::vec4& box);

}  // namespace meniscus

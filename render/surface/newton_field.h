#pragma once
// What the method "newton" keeps of a field in textures, the same for every view.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/ball_overlaps.h"
#include "core/metaball_field.h"
#include "render/gl/objects.h"
#include "render/surface/projected_field.h"

namespace meniscus {

class NewtonField {
 public:
  /// With the context current. `terms` and `ambientCells` as the method's parameters; without an ambient
  /// field if either is 0; activeSmaller: whether smaller balls, too, may be active in a ball's part of a
  /// ray. Throws InputError if the lists become too long.
  void prepare(const MetaballField& field, int terms, int ambientCells, bool activeSmaller);
  /// Of each ball by rank, as `projected` has it; balls that are not in it are met by no ray.
  void uploadProjected(const ProjectedField& projected);
  /// To the texture units of shaders/include/newton_balls.glsl, newton_field.glsl and what includes them.
  void bind() const;
  std::uint64_t bytes() const;

  BallOverlaps overlaps;
  std::vector<std::uint32_t> rankOf;  ///< of each ball of the field
  /// Squared radius of each ball's hull, by rank; 0: it has none. A surface point of n balls lies where one
  /// of them has at least an n-th of the level.
  std::vector<float> hulls;
  bool ambient = false;
  glm::vec3 ambientBase{0.0f};
  float ambientSpacing = 1;
  glm::ivec3 ambientNodes{0};

 private:
  void uploadBalls(const MetaballField& field);
  void uploadLists(bool activeSmaller);
  void uploadAmbient(const MetaballField& field, int terms, int cells);

  gl::Texture balls_, others_, lists_, projected_;
  gl::Object ambient_;
  std::vector<ProjectedBall> byRank_;
};

}  // namespace meniscus

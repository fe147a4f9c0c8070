#pragma once
// A field's balls in the order in which rays can enter them, where the shaders of lists find them.

#include "render/gl/storage.h"
#include "render/surface/ball_texture.h"
#include "render/surface/projected_field.h"

namespace meniscus {

class ListBalls {
 public:
  /// projected: by BallOrder::distance, of the same view and tile.
  void upload(const ProjectedField& projected, const View& view, const Tile& tile);
  /// Storage 0, textures 5 and 6, uniforms 1 of shaders/include/ball_ray.glsl, field.glsl and lists.glsl.
  void bind() const;
  /// From a place on a ray to a depth between 0 and 1 (ListsUniforms of shaders/include/lists.glsl).
  float placeScale() const { return placeScale_; }
  std::uint64_t bytes() const;

 private:
  // Three texels of tOrder of shaders/include/lists.glsl.
  struct Order {
    glm::vec4 box, coreBox, distance;
  };

  gl::Storage balls_;
  BallTexture ballTexture_{sizeof(ProjectedBall) / 16}, orderTexture_{sizeof(Order) / 16};
  gl::Buffer uniforms_;
  float placeScale_ = 1;
};

}  // namespace meniscus

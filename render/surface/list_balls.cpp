#include "render/surface/list_balls.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {

void ListBalls::upload(const ProjectedField& projected, const View& view, const Tile& tile) {
  placeScale_ = static_cast<float>(0.45 / std::max(projected.reach, 1e-30));
  const bool perspective = view.projection == Projection::perspective;
  const double eyeAbove = perspective ? std::max(static_cast<double>(projected.block.plane.y), 0.0) : 0.0;
  std::vector<Order> order(projected.balls.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double stretch = largestStretch(view, tile, projected.boxes[i]);
    const double place = projected.distances[i] - eyeAbove * (stretch - 1);
    const double depth = 0.5 + place * static_cast<double>(placeScale_) - 4e-6;
    order[i] = {
        projected.boxes[i],
        projected.coreBoxes[i],
        {std::nextafter(static_cast<float>(projected.distances[i]), -std::numeric_limits<float>::infinity()),
         static_cast<float>(std::clamp(depth, 0.0, 1.0)), 0, 0}};
  }
  const std::uint64_t bytes = projected.balls.size() * sizeof(ProjectedBall);
  balls_.reserve(bytes);
  balls_.write(projected.balls.data(), bytes);
  ballTexture_.upload(projected.balls.data(), projected.balls.size());
  orderTexture_.upload(order.data(), order.size());
  if (!uniforms_.object) uniforms_ = gl::Buffer::updatable(sizeof(FieldBlock));
  uniforms_.update(&projected.block);
}

void ListBalls::bind() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms_.object.name());
  balls_.bindStorage(0);
  ballTexture_.bind(5);
  orderTexture_.bind(6);
}

std::uint64_t ListBalls::bytes() const {
  return balls_.bytes() + ballTexture_.bytes() + orderTexture_.bytes();
}

}  // namespace meniscus

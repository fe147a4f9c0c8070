#include "render/view_block.h"

#include "render/two_floats.h"

namespace meniscus {

namespace {

// The first 12 significant bits of a number, and what is left of it.
float upper12(double x) {
  return f32::upperHalf(high(x));
}
float below12(double x) {
  return static_cast<float>(x - static_cast<double>(upper12(x)));
}

glm::vec4 highRow(const glm::dvec4& row) {
  return {upper12(row.x), upper12(row.y), upper12(row.z), high(row.w)};
}
glm::vec4 lowRow(const glm::dvec4& row) {
  return {below12(row.x), below12(row.y), below12(row.z), low(row.w)};
}

}  // namespace

f32::ViewBlock makeViewBlock(const View& view, const glm::dvec3& primitivesOrigin, const Tile& tile,
                             glm::vec2 sampleShift) {
  const glm::dmat3 rows = glm::transpose(view.rotation);
  const glm::dvec3 translation = view.rotation * (primitivesOrigin - view.pivot);
  const double perPixel = 1.0 / view.pixelSize;
  const glm::dvec4 x = glm::dvec4(rows[0], translation.x) * perPixel,
                   y = glm::dvec4(rows[1], translation.y) * perPixel, z(rows[2], translation.z);
  const bool perspective = view.projection == Projection::perspective;

  f32::ViewBlock block{};
  block.xRowHi = highRow(x);
  block.yRowHi = highRow(y);
  block.zRowHi = highRow(z);
  block.xRowLo = lowRow(x);
  block.yRowLo = lowRow(y);
  block.zRowLo = lowRow(z);
  block.scale = {high(view.pixelSize), low(view.pixelSize), perspective ? 1.0f : 0.0f, 0.0f};
  block.center = {high(view.center.x), high(view.center.y), low(view.center.x), low(view.center.y)};
  block.depth = {high(view.distance), low(view.distance), high(view.nearZ), high(view.farZ)};
  // depthValue(): (z - far) * factor / (distance - z) is 1 on the near plane; without the division if
  // orthographic.
  const double span = view.nearZ - view.farZ;
  block.depthMap = {high((perspective ? view.distance - view.nearZ : 1.0) / span), low(view.nearZ), 0.0f,
                    0.0f};
  block.tile = {static_cast<float>(tile.x) + sampleShift.x, static_cast<float>(tile.y) + sampleShift.y,
                static_cast<float>(tile.width), static_cast<float>(tile.height)};
  return block;
}

}  // namespace meniscus

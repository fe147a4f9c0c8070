#include "app/scene/mvs_clip.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace meniscus {

MvsClip::MvsClip(const MvsNode& node, std::vector<std::string>& unsupported) {
  const JsonPlace type = node.at("type");
  if (type.string() == "plane") {
    axes_[0] = node.at("normal").vector();
    if (!(glm::length(axes_[0]) > 0)) node.at("normal").fail("must not be zero");
    center_ = node.at("point").vector();
  } else if (type.string() == "sphere") {
    shape_ = Shape::sphere;
    center_ = node.at("center").vector();
    half_.x = 1;
    if (const auto radius = node.find("radius")) half_.x = radius->number();
  } else if (type.string() == "box") {
    shape_ = Shape::box;
    center_ = node.at("center").vector();
    if (const auto size = node.find("size")) half_ = size->vector() * 0.5;
    if (const auto rotation = node.find("rotation")) {
      const std::vector<double> m = rotation->numbers(9);
      for (std::size_t i = 0; i < 3; ++i) axes_[i] = {m[3 * i], m[3 * i + 1], m[3 * i + 2]};
    }
  } else {
    type.fail(fmt::format("'{}' is no shape to clip with; there are plane, sphere and box", type.string()));
  }
  if (const auto invert = node.find("invert")) invert_ = invert->boolean();
  const auto variant = node.find("variant");
  if (!variant || variant->string() == "pixel")
    unsupported.push_back(node.place().path() +
                          ": atoms are cut away as a whole, not where the shape cuts them");
  node.listOtherParameters(
      {"type", "normal", "point", "center", "radius", "size", "rotation", "invert", "variant"}, unsupported);
}

bool MvsClip::cuts(const glm::dvec3& point) const {
  const glm::dvec3 d = point - center_;
  bool inside = true;
  switch (shape_) {
    case Shape::plane:
      inside = glm::dot(d, axes_[0]) > 0;
      break;
    case Shape::sphere:
      inside = glm::length(d) < half_.x;
      break;
    case Shape::box:
      for (int i = 0; i < 3; ++i) inside = inside && std::abs(glm::dot(d, axes_[i])) < half_[i];
      break;
  }
  return inside != invert_;
}

}  // namespace meniscus

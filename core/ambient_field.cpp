#include "core/ambient_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"

namespace meniscus {

namespace {

// `values` are reordered.
double withoutLargest(std::vector<double>& values, int terms) {
  if (values.size() <= static_cast<std::size_t>(terms)) return 0;
  const auto rest = values.begin() + terms;
  std::nth_element(values.begin(), rest, values.end(),
                   [](double a, double b) { return std::abs(a) > std::abs(b); });
  std::sort(rest, values.end());  // the sum does not depend on the order of the balls
  double sum = 0;
  for (auto value = rest; value != values.end(); ++value) sum += *value;
  return sum;
}

void addTerm(const MetaballField& field, const Metaball& ball, const glm::dvec3& point,
             std::vector<double>& values) {
  const glm::dvec3 v = point - glm::dvec3(ball.center);
  const double support = static_cast<double>(ball.support);
  const double w = 1 - glm::dot(v, v) / (support * support);
  if (w > 0) values.push_back(static_cast<double>(ball.coefficient) * kernelValue(field.kernel, w));
}

}  // namespace

double AmbientField::at(const glm::dvec3& point) const {
  const glm::dvec3 most = glm::dvec3(size - 1);
  const glm::dvec3 place =
      glm::clamp((point - glm::dvec3(base)) / static_cast<double>(spacing), glm::dvec3(0), most);
  const glm::dvec3 cell = glm::min(glm::floor(place), most - 1.0), f = place - cell;
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const glm::ivec3 node = glm::ivec3(cell) + glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
    const double weight =
        ((c & 1) != 0 ? f.x : 1 - f.x) * ((c & 2) != 0 ? f.y : 1 - f.y) * ((c & 4) != 0 ? f.z : 1 - f.z);
    sum += weight * static_cast<double>(
                        values[static_cast<std::size_t>((node.z * size.y + node.y) * size.x + node.x)]);
  }
  return sum;
}

AmbientField makeAmbientField(const MetaballField& field, int terms, int cells) {
  MENISCUS_CHECK(terms >= 0 && cells >= 1 && !field.balls.empty());
  const auto [low, high] = supportBox(field);
  const glm::dvec3 extent = high - low;
  AmbientField out;
  out.base = glm::vec3(low);
  out.spacing = static_cast<float>(std::max({extent.x, extent.y, extent.z}) / cells);
  const double spacing = static_cast<double>(out.spacing);
  out.size = glm::max(glm::ivec3(glm::ceil(extent / spacing * (1 - 1e-6))), glm::ivec3(1)) + 1;
  out.values.resize(static_cast<std::size_t>(out.size.x) * static_cast<std::size_t>(out.size.y) *
                    static_cast<std::size_t>(out.size.z));
  const auto reaches = [&](const Metaball& ball, int axis, double at) {
    return std::abs(static_cast<double>(ball.center[axis]) - at) < static_cast<double>(ball.support);
  };
  tbb::parallel_for(0, out.size.z, [&](int z) {
    std::vector<const Metaball*> ofLayer, ofRow;
    std::vector<double> values;
    glm::dvec3 at(out.base);
    at.z += spacing * z;
    for (const Metaball& ball : field.balls)
      if (reaches(ball, 2, at.z)) ofLayer.push_back(&ball);
    for (int y = 0; y < out.size.y; ++y) {
      at.y = static_cast<double>(out.base.y) + spacing * y;
      ofRow.clear();
      for (const Metaball* ball : ofLayer)
        if (reaches(*ball, 1, at.y)) ofRow.push_back(ball);
      for (int x = 0; x < out.size.x; ++x) {
        at.x = static_cast<double>(out.base.x) + spacing * x;
        values.clear();
        for (const Metaball* ball : ofRow)
          if (reaches(*ball, 0, at.x)) addTerm(field, *ball, at, values);
        out.values[static_cast<std::size_t>((z * out.size.y + y) * out.size.x + x)] =
            static_cast<float>(withoutLargest(values, terms));
      }
    }
  });
  return out;
}

double restOfField(const MetaballField& field, int terms, const glm::dvec3& point) {
  std::vector<double> values;
  for (const Metaball& ball : field.balls) addTerm(field, ball, point, values);
  return withoutLargest(values, terms);
}

}  // namespace meniscus

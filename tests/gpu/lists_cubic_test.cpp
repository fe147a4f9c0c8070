// The paper's cubic pieces: right for what they are, and how far that is from the kernel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_rays.h"
#include "tests/support/paths.h"

namespace meniscus {
namespace {

SurfaceSettings cubics(std::map<std::string, double> parameters = {}) {
  parameters["exact"] = 0;
  return {"lists", std::move(parameters)};
}

/// The sum of cubics along one ray, from the definition (Szécsi and Illés 2012, §3): value and slope agree
/// with each ball's share at both ends of its chord and in the middle.
class CubicField {
 public:
  CubicField(const MetaballField& field, const glm::dvec3& origin, const View& view, glm::dvec2 pixel)
      : level_(field.level) {
    const Ray ray = rayThrough(view, pixel);
    for (const Metaball& ball : field.balls) {
      const glm::dvec3 toCenter =
          view.rotation * ((origin - view.pivot) + glm::dvec3(ball.center)) - ray.origin;
      const double middle = glm::dot(toCenter, ray.direction), support = static_cast<double>(ball.support);
      const double half2 =
          support * support - glm::dot(toCenter - middle * ray.direction, toCenter - middle * ray.direction);
      if (!(half2 > 0)) continue;
      const double peak =
          static_cast<double>(ball.coefficient) * kernelValue(field.kernel, half2 / (support * support));
      terms_.push_back({middle, std::sqrt(half2), peak});
      for (const double place : {middle - terms_.back().half, middle, middle + terms_.back().half})
        separators_.push_back(place);
    }
    std::sort(separators_.begin(), separators_.end());
  }
  double operator()(double t) const {
    double sum = -level_;
    for (const Term& term : terms_) {
      const double x = 1 - std::abs(t - term.middle) / term.half;
      if (x > 0) sum += term.peak * x * x * (3 - 2 * x);
    }
    return sum;
  }
  /// The first root, of 32 samples of each piece; nothing if there is none or two are too near each other.
  std::optional<double> first(bool& clear) const {
    for (std::size_t i = 0; i + 1 < separators_.size(); ++i) {
      const double from = separators_[i], size = separators_[i + 1] - from;
      for (int k = 0; k < 32; ++k) {
        const double a = from + size * k / 32, b = from + size * (k + 1) / 32;
        const double value = (*this)(b);
        if (std::abs(value) < 1e-4) clear = false;
        if (value > 0) return bisected(a, b);
      }
    }
    return std::nullopt;
  }

 private:
  struct Term {
    double middle, half, peak;
  };
  double bisected(double low, double high) const {
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      ((*this)(middle) > 0 ? high : low) = middle;
    }
    return high;
  }
  double level_;
  std::vector<Term> terms_;
  std::vector<double> separators_;
};

class ListsCubic : public test::SurfaceTest {};

TEST_F(ListsCubic, PiecesAreTheCubics) {
  const test::SurfaceScene scene = test::randomScene(200, 3);
  const View view = viewOf(scene, {80, 60});
  const HitImage image = draw(scene, view, cubics());
  const HitImage walked = draw(scene, view, cubics({{"array", 3}}));
  const HitImage all = draw(scene, view, cubics({{"culling", 0}}));
  int compared = 0, wrong = 0;
  double largest = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      const auto at = static_cast<std::size_t>(y * 80 + x);
      bool clear = true;
      const CubicField field(scene.primitives->surfaces[0], scene.primitives->origin, view,
                             {x + 0.5, y + 0.5});
      const std::optional<double> root = field.first(clear);
      if (!clear) continue;
      for (const HitImage* drawn : {&image, &walked, &all}) {
        if (root.has_value() != (drawn->id[at] != 0)) ++wrong;
        if (!root || drawn->id[at] == 0) continue;
        ++compared;
        largest = std::max(largest, std::abs(static_cast<double>(drawn->distance[at]) - *root) / *root);
      }
    }
  }
  EXPECT_GT(compared, 3000);
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(largest, 2e-6);
}

// Against the kernel itself; docs/measured/lists.md has the figures.
TEST_F(ListsCubic, AreFartherFromTheTruthThanExactPieces) {
  const test::SurfaceScene scene = test::moleculeScene(test::projectFile("molecules/1ubq.pdb"));
  const View view = viewOf(scene, {160, 120});
  const HitErrors cubic = judge(scene, view, cubics(), "cubic");
  EXPECT_LT(cubic.relativeRms, 0.01);
  EXPECT_GT(cubic.relativeRms, 1e-5);
  EXPECT_LT(cubic.missed + cubic.falseHits, 40u);
}

// One ball's error is largest through its centre: 0.0128 of the peak (0.0082 where the peak's w is 0.75,
// 0.0049 where it is 0.5).
TEST_F(ListsCubic, OneBallIsOffByAtMostAnEightieth) {
  for (const auto& [a, most] : {std::pair{1.0, 0.0129}, {0.75, 0.0083}, {0.5, 0.0050}}) {
    double largest = 0;
    for (int i = 0; i <= 10000; ++i) {
      const double x = i / 10000.0, w = a * (1 - (1 - x) * (1 - x));
      const double peak = kernelValue({}, a);
      largest = std::max(largest, std::abs(kernelValue({}, w) - peak * x * x * (3 - 2 * x)));
    }
    EXPECT_LT(largest, most) << a;
    EXPECT_GT(largest, most - 0.0003) << a;
  }
  // On the screen: the root of x^2 (3 - 2 x) = T / peak.
  MetaballField field;
  field.balls.push_back({{0, 0, 0}, 2.0f, 1.0f, 0x808080, 1});
  View view;
  view.projection = Projection::orthographic;
  view.size = {1, 1};
  view.pixelSize = 0.01;
  view.center = {0.5, 0.5};
  view.nearZ = 10;
  view.farZ = -10;
  for (const double level : {0.1, 0.3, 0.5, 0.8}) {
    field.level = level;
    const HitImage image = draw(test::SurfaceScene(field), view, cubics());
    const double x = 0.5 - std::sin(std::asin(1 - 2 * level) / 3);
    EXPECT_NEAR(image.distance[0], 10 - 2 * (1 - x), 2e-6);
  }
}

}  // namespace
}  // namespace meniscus

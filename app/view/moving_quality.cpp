#include "app/view/moving_quality.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/picture_drawer.h"

namespace meniscus {
namespace {

// How coarse a picture is: its sides are halved by so many levels.
constexpr int kLevelsToHalf = 4;
// Effects return before the picture is finer than the first, and go before it is coarser than the second.
constexpr int kSharpEnough = 4, kCoarsest = 6, kLeastLevel = 11;
// Frames that take less than these shares of the budget leave room for an effect, or for the pixels of the
// next level, half as many again.
constexpr double kRoomForEffect = 0.5, kRoomForPixels = 0.6;
constexpr double kFarTooSlow = 2;
constexpr int kFramesToLookAt = 6;

struct Cut {
  const char* name;
  bool (*applies)(const RenderOptions&);
  void (*apply)(RenderOptions&);
};

// The dearest first: rays that are traced, and then as measured (docs/measured/effects_cost.md).
constexpr Cut kCuts[] = {
    {"mirrors and glass", [](const RenderOptions& o) { return o.trace.light(); },
     [](RenderOptions& o) { o.trace.reflect = o.trace.refract = 0; }},
    {"all traced rays of a pixel but one",
     [](const RenderOptions& o) { return std::max(o.trace.shadows, o.trace.occlusion) > 1; },
     [](RenderOptions& o) {
       o.trace.shadows = std::min(o.trace.shadows, 1);
       o.trace.occlusion = std::min(o.trace.occlusion, 1);
     }},
    {"traced rays", [](const RenderOptions& o) { return std::max(o.trace.shadows, o.trace.occlusion) > 0; },
     [](RenderOptions& o) {
       const RenderSettings traced = renderSettingsOf(o);  // maps take the place of rays
       o.shadows.mode = traced.shadows.mode;
       o.occlusion.on = traced.occlusion.on;
       o.trace.shadows = o.trace.occlusion = 0;
     }},
    {"ambient occlusion", [](const RenderOptions& o) { return o.occlusion.on; },
     [](RenderOptions& o) {
       // Without it the light would change, too.
       const Lighting light = lightOf(o);
       o.keyLight = light.key.intensity;
       o.fillLight = light.fill.intensity;
       o.ambientLight = light.ambient;
       o.occlusion.on = false;
     }},
    {"soft edges of shadows", [](const RenderOptions& o) { return o.shadows.mode == ShadowMode::soft; },
     [](RenderOptions& o) { o.shadows.mode = ShadowMode::hard; }},
    {"depth unsharp masking", [](const RenderOptions& o) { return o.depthUnsharp.mode != UnsharpMode::off; },
     [](RenderOptions& o) { o.depthUnsharp.mode = UnsharpMode::off; }},
    {"shadows", [](const RenderOptions& o) { return o.shadows.mode != ShadowMode::off; },
     [](RenderOptions& o) { o.shadows.mode = ShadowMode::off; }},
    {"outlines", [](const RenderOptions& o) { return o.lines.any(); },
     [](RenderOptions& o) {
       o.lines.silhouettes = o.lines.creases = false;
       o.lines.groups = LineGroups::none;
     }}};

// The names of the first `most` cuts that apply, one after the other: some only apply after others.
std::vector<std::string> leaveOut(RenderOptions& options, int most) {
  std::vector<std::string> names;
  for (const Cut& cut : kCuts) {
    if (static_cast<int>(names.size()) >= most) break;
    if (!cut.applies(options)) continue;
    cut.apply(options);
    names.emplace_back(cut.name);
  }
  return names;
}

}  // namespace

std::vector<std::string> possibleCuts(RenderOptions options, int most) {
  return leaveOut(options, most);
}

RenderOptions reduced(RenderOptions options, const MovingQuality& quality) {
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * quality.scale)));
  };
  options.size = {side(options.size.width), side(options.size.height)};
  options.samples = 1;
  options.shadows.samples = std::min(options.shadows.samples, 16);
  options.occlusion.directions = 8;
  options.lines.width = std::max(0.5, options.lines.width * quality.scale);
  leaveOut(options, quality.cuts);
  return options;
}

void QualityGovernor::change(int level, int cuts) {
  level_ = std::clamp(level, 0, kLeastLevel);
  quality_ = {std::exp2(-static_cast<double>(level_) / kLevelsToHalf), cuts};
  isNew_ = true;
  frames_ = 0;
  worst_ = 0;
}

void QualityGovernor::reset(int possibleCuts) {
  change(kSharpEnough, possibleCuts);
  tooSlow_.assign(static_cast<std::size_t>(possibleCuts) + 1, false);
}

void QualityGovernor::measured(double milliseconds, double budget) {
  const double share = std::max(milliseconds, 1e-3) / budget;
  // The first of its size makes its textures, too.
  if (std::exchange(isNew_, false) && share < kFarTooSlow) return;
  const auto cuts = static_cast<std::size_t>(quality_.cuts);
  if (share > 1) {
    const int coarser =
        level_ + std::clamp(static_cast<int>(std::ceil(2 * std::log2(share))), 1, kLevelsToHalf);
    if (coarser > kCoarsest && cuts + 1 < tooSlow_.size()) {
      tooSlow_[cuts] = true;
      change(kCoarsest, quality_.cuts + 1);
    } else if (level_ < kLeastLevel) {
      change(coarser, quality_.cuts);
    }
    return;
  }
  // More is drawn only if the slowest of some frames left room for it: times vary, and a late frame is felt.
  worst_ = std::max(worst_, share);
  if (++frames_ < kFramesToLookAt) return;
  if (worst_ < kRoomForEffect && level_ <= kSharpEnough && cuts > 0 && !tooSlow_[cuts - 1]) {
    change(level_, quality_.cuts - 1);
  } else if (level_ > 0 && worst_ < kRoomForPixels) {
    change(level_ - 1, quality_.cuts);
  } else {
    frames_ = 0;
    worst_ = 0;
  }
}

}  // namespace meniscus

#pragma once
// What a pass can be told: plain structs with defaults, units and ranges. An effect that is off costs
// nothing.

#include <cstdint>

namespace meniscus {

enum class ShadowMode : std::uint8_t { off, hard, soft };

/// Shadows of the key light.
struct ShadowSettings {
  ShadowMode mode = ShadowMode::off;
  double penumbra = 2.0;  ///< width of a soft shadow's edge [Å], > 0
  int samples = 64;       ///< of the shadow map per ray, soft shadows, 1..kMaxShadowSamples
  int probes = 8;         ///< if these agree, the others are left out; 0 = all are taken
  bool operator==(const ShadowSettings&) const = default;
};

struct RenderSettings {
  int samples =
      16;  ///< rays per pixel, 1..kMaxSamples; fixed positions, so the same command gives the same bytes
  ShadowSettings shadows;
  bool operator==(const RenderSettings&) const = default;
};

inline constexpr int kMaxSamples = 256;
inline constexpr int kMaxShadowSamples = 256;

}  // namespace meniscus

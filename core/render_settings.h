#pragma once
// What a pass can be told: plain structs with defaults, units and ranges.

namespace meniscus {

struct RenderSettings {
  int samples = 16;  ///< rays per pixel, 1..256; fixed positions, so the same command gives the same bytes
  bool operator==(const RenderSettings&) const = default;
};

inline constexpr int kMaxSamples = 256;

}  // namespace meniscus

#pragma once
// Where in a pixel the rays of a supersampled picture go.

#include <cstdint>
#include <glm/vec2.hpp>

namespace meniscus {

/// The binary digits of i mirrored at the point, in [0, 1): van der Corput's sequence, of which any first
/// terms are evenly spread.
double radicalInverse2(std::uint32_t i);

/// Offset from the pixel's centre [pixels], each coordinate in [-0.5, 0.5), of sample `index` of `count`: the
/// Hammersley set (Niederreiter 1992, §3.1) with ranks for ordinates, so that each of `count` columns and
/// rows holds one. One sample is the centre. Multiples of 1/256: added to pixel coordinates below 65,536 they
/// stay exact in float32.
glm::vec2 sampleOffset(int index, int count);

}  // namespace meniscus

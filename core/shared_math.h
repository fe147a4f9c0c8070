#pragma once
// shaders/shared/*.glsl as C++, once in float (meniscus::f32) and once in double (meniscus::f64). The dialect
// is described in shaders/shared/README.md.

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#define FN inline
#define INOUT(T) T&
#define PRECISE

namespace meniscus::f32 {
using real = float;
using glm::cross, glm::dot, glm::length, glm::normalize;
using glm::vec2, glm::vec3, glm::vec4;
using std::abs, std::sqrt;
inline float max(float a, float b) {
  return a > b ? a : b;
}
inline float min(float a, float b) {
  return a < b ? a : b;
}
#define SPLITTER 4097         // 2^12 + 1
#define PARALLEL_LIMIT 1e-12  // below this, sin^2 and cos of unit float32 vectors are rounding
#define LARGEST 1e30
// Each needs those before it.
// clang-format off
#include "shaders/shared/double_float.glsl"
#include "shaders/shared/view_block.glsl"
#include "shaders/shared/projection.glsl"
#include "shaders/shared/octahedral.glsl"
#include "shaders/shared/quadrics.glsl"
#include "shaders/shared/metaball.glsl"
// clang-format on
#undef SPLITTER
#undef PARALLEL_LIMIT
#undef LARGEST
}  // namespace meniscus::f32

namespace meniscus::f64 {
using real = double;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using glm::cross, glm::dot, glm::length, glm::normalize;
using std::abs, std::sqrt;
inline double max(double a, double b) {
  return a > b ? a : b;
}
inline double min(double a, double b) {
  return a < b ? a : b;
}
#define SPLITTER 134217729  // 2^27 + 1
#define PARALLEL_LIMIT 1e-30
#define LARGEST 1e300
// Each needs those before it.
// clang-format off
#include "shaders/shared/double_float.glsl"
#include "shaders/shared/view_block.glsl"
#include "shaders/shared/projection.glsl"
#include "shaders/shared/octahedral.glsl"
#include "shaders/shared/quadrics.glsl"
#include "shaders/shared/metaball.glsl"
// clang-format on
#undef SPLITTER
#undef PARALLEL_LIMIT
#undef LARGEST
}  // namespace meniscus::f64

#undef FN
#undef INOUT
#undef PRECISE

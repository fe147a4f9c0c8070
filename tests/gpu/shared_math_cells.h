#pragma once
// shared_math_calls.glsl as C++ in float and in double and as GLSL, and what it means that the three agree.
//
// Tolerances. Numbers as hi + lo are compared in double, relative to the size of what enters the result:
// 2^-44 for double_float.glsl. Everything else: a result may differ by as much as it moves in double when
// each input moves by up to 16 units of float32 rounding (64 random moves: an estimate of the condition),
// plus 8 roundings of the result itself. Where such a move turns a hit into a miss the case decides nothing
// and is counted.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/shared_math.h"
#include "tests/support/random.h"

#define FN inline
#define INOUT(T) T&

namespace meniscus::f32 {
#include "tests/gpu/shared_math_calls.glsl"
}  // namespace meniscus::f32

namespace meniscus::f64 {
#include "tests/gpu/shared_math_calls.glsl"
}  // namespace meniscus::f64

#undef FN
#undef INOUT

namespace meniscus::test {

/// A function of shared_math_calls.glsl in its three forms; `name` is the GLSL one.
struct SharedCall {
  const char* name;
  void (*single)(f32::Cell&);
  void (*twice)(f64::Cell&);
};

/// Text of shared_math_calls.glsl.
std::string sharedCallsText();

/// Makes the inputs of case `index`, from in_[0] on.
using Inputs = std::vector<float>;
using Generator = std::function<Inputs(Random&, std::size_t index)>;
inline void append(Inputs& out, glm::vec3 v) {
  for (int k = 0; k < 3; ++k) out.push_back(v[k]);
}

/// One function's cells: as computed by the GPU, in float and in double.
struct Results {
  std::vector<f32::Cell> gpu, single;
  std::vector<f64::Cell> twice;
};

Results evaluate(const SharedCall& call, std::uint64_t seed, const Generator& generate,
                 std::size_t count = 20000);

/// Outputs are `pairs` of hi and lo. Error allowed: `bits` times `size` of the case's output. Results out of
/// float's range are no part of the contract and not judged; at least half of the results must be.
using PairSize = std::function<double(const f64::Cell&, std::size_t pair)>;
void expectPairs(const SharedCall& call, std::uint64_t seed, const Generator& generate, std::size_t pairs,
                 double bits, const PairSize& size);

/// Outputs of any kind.
struct Shape {
  std::vector<std::pair<std::size_t, std::size_t>>
      groups;         ///< first, count: vectors, whose components share errors
  bool flag = false;  ///< out_[0] is 0 or 1
  std::function<bool(std::size_t)> exact = [](std::size_t) { return false; };  ///< inputs that are not moved
  /// What the roundings are relative to, beside the result, where it is a difference by definition.
  std::function<double(const f64::Cell&)> size = [](const f64::Cell&) { return 0.0; };
  double undecidedShare = 0.05;
};
void expectConditioned(const SharedCall& call, std::uint64_t seed, const Generator& generate,
                       const Shape& shape, std::size_t count = 4000);

}  // namespace meniscus::test

#define MENISCUS_SHARED_CALL(name)                      \
  ::meniscus::test::SharedCall {                        \
#name, ::meniscus::f32::name, ::meniscus::f64::name \
  }

#include "tests/gpu/shared_math_cells.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "render/gl/objects.h"
#include "render/shader_library.h"
#include "tests/support/paths.h"

namespace meniscus::test {

namespace {

constexpr std::size_t kIn = 64, kOut = 16;
constexpr double kEpsilon = 0x1p-24;     // half a unit in the last place of 1.0f
constexpr double kUnderflow = 0x1p-120;  // drivers may flush denormals; double_float.glsl bars underflow
static_assert(sizeof(f32::Cell) == (kIn + kOut) * sizeof(float));

gl::Object computeProgram(const std::string& text) {
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  gl::Object program(gl::ObjectKind::program, glCreateProgram());
  glAttachShader(program.name(), shader);
  glLinkProgram(program.name());
  std::string log(4096, '\0');
  GLsizei written = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  glDeleteShader(shader);
  GLint ok = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) throw GraphicsError("the compute program was refused: " + log);
  return program;
}

// Runs `name` over all cells on the GPU, filling in out_.
void runOnGpu(const char* name, std::vector<f32::Cell>& cells) {
  const ShaderLibrary library{{}};
  std::string text = "#version 450 core\n";
  for (const char* part :
       {"include/view.glsl", "shared/octahedral.glsl", "shared/quadrics.glsl", "shared/metaball.glsl"}) {
    text += library.source(part).text;
  }
  text += sharedCallsText() +
          "layout(local_size_x = 64) in;\n"
          "layout(std430, binding = 1) buffer Cells { Cell cells[]; };\n"
          "layout(location = 0) uniform uint uCount;\n"
          "void main() {\n"
          "  uint i = gl_GlobalInvocationID.x;\n"
          "  if (i >= uCount) return;\n"
          "  Cell c = cells[i];\n"
          "  " +
          std::string(name) +
          "(c);\n"
          "  cells[i] = c;\n"
          "}\n";
  const gl::Object program = computeProgram(text);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  const gl::Object owner(gl::ObjectKind::buffer, buffer);
  const auto bytes = static_cast<GLsizeiptr>(cells.size() * sizeof(f32::Cell));
  glNamedBufferStorage(buffer, bytes, cells.data(), 0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffer);
  glUseProgram(program.name());
  glUniform1ui(0, static_cast<GLuint>(cells.size()));
  glDispatchCompute(static_cast<GLuint>((cells.size() + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffer, 0, bytes, cells.data());
  glUseProgram(0);
}

f64::Cell inDouble(const f32::Cell& cell) {
  f64::Cell out{};
  for (std::size_t i = 0; i < std::size(cell.in_); ++i) out.in_[i] = static_cast<double>(cell.in_[i]);
  return out;
}

std::string describe(const f32::Cell& cell) {
  std::string out;
  for (const float x : cell.in_)
    out += (x == 0 ? "0" : std::to_string(x) + " (" + std::to_string(std::ilogb(x)) + ")") + " ";
  return out;
}

double pairAt(const f32::Cell& c, std::size_t i) {
  return static_cast<double>(c.out_[i]) + static_cast<double>(c.out_[i + 1]);
}
double pairAt(const f64::Cell& c, std::size_t i) {
  return c.out_[i] + c.out_[i + 1];
}

}  // namespace

std::string sharedCallsText() {
  const std::string name = projectFile("tests/gpu/shared_math_calls.glsl");
  std::ifstream in(name, std::ios::binary);
  if (!in) throw InputError(name + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

Results evaluate(const SharedCall& call, std::uint64_t seed, const Generator& generate, std::size_t count) {
  Results r;
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    f32::Cell cell{};
    const Inputs inputs = generate(random, i);
    std::copy(inputs.begin(), inputs.end(), cell.in_);
    r.gpu.push_back(cell);
    r.twice.push_back(inDouble(cell));
    call.twice(r.twice.back());
    call.single(cell);
    r.single.push_back(cell);
  }
  runOnGpu(call.name, r.gpu);
  return r;
}

void expectPairs(const SharedCall& call, std::uint64_t seed, const Generator& generate, std::size_t pairs,
                 double bits, const PairSize& size) {
  const Results r = evaluate(call, seed, generate);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < r.gpu.size() && !testing::Test::HasFailure(); ++i) {
    for (std::size_t p = 0; p < pairs; ++p) {
      const double truth = pairAt(r.twice[i], 2 * p), single = pairAt(r.single[i], 2 * p),
                   gpu = pairAt(r.gpu[i], 2 * p);
      if (!std::isfinite(single) || !std::isfinite(truth) || std::abs(truth) > 1e37) continue;
      const double tolerance = bits * size(r.twice[i], p) + kUnderflow;
      EXPECT_NEAR(single, truth, tolerance)
          << call.name << " as C++, output " << p << ": " << describe(r.single[i]);
      EXPECT_NEAR(gpu, truth, tolerance)
          << call.name << " as GLSL, output " << p << ": " << describe(r.single[i]);
      ++judged;
    }
  }
  EXPECT_GT(judged, r.gpu.size() * pairs / 2) << call.name;
}

void expectConditioned(const SharedCall& call, std::uint64_t seed, const Generator& generate,
                       const Shape& shape, std::size_t count) {
  const Results r = evaluate(call, seed, generate, count);
  Random moves(seed + 1000);
  std::size_t undecided = 0;
  for (std::size_t i = 0; i < r.gpu.size() && !testing::Test::HasFailure(); ++i) {
    double moved[16] = {};
    bool decided = true;
    for (int m = 0; m < 64; ++m) {
      f64::Cell cell = r.twice[i];
      for (std::size_t k = 0; k < std::size(cell.in_); ++k) {
        if (!shape.exact(k)) cell.in_[k] *= 1 + 16 * kEpsilon * moves.uniform(-1, 1);
      }
      call.twice(cell);
      if (shape.flag && cell.out_[0] != r.twice[i].out_[0]) decided = false;
      for (std::size_t k = 0; k < 16; ++k)
        moved[k] = std::max(moved[k], std::abs(cell.out_[k] - r.twice[i].out_[k]));
    }
    if (!decided) {
      ++undecided;
      continue;
    }
    if (shape.flag) {
      EXPECT_EQ(static_cast<double>(r.single[i].out_[0]), r.twice[i].out_[0])
          << call.name << " as C++: " << describe(r.single[i]);
      EXPECT_EQ(static_cast<double>(r.gpu[i].out_[0]), r.twice[i].out_[0])
          << call.name << " as GLSL: " << describe(r.single[i]);
    }
    for (const auto& [first, size] : shape.groups) {
      double largest = shape.size(r.twice[i]), motion = 0;
      for (std::size_t k = first; k < first + size; ++k) {
        largest = std::max(largest, std::abs(r.twice[i].out_[k]));
        motion = std::max(motion, moved[k]);
      }
      const double tolerance = motion + 8 * kEpsilon * largest + kUnderflow;
      for (std::size_t k = first; k < first + size; ++k) {
        const auto single = static_cast<double>(r.single[i].out_[k]),
                   gpu = static_cast<double>(r.gpu[i].out_[k]);
        if (!std::isfinite(single) || !std::isfinite(tolerance)) continue;  // out of float's range
        EXPECT_NEAR(single, r.twice[i].out_[k], tolerance)
            << call.name << " as C++, " << k << ": " << describe(r.single[i]);
        EXPECT_NEAR(gpu, r.twice[i].out_[k], tolerance)
            << call.name << " as GLSL, " << k << ": " << describe(r.single[i]);
        EXPECT_NEAR(gpu, single, 2 * tolerance) << call.name << ", " << k << ": " << describe(r.single[i]);
      }
    }
  }
  EXPECT_LE(static_cast<double>(undecided), shape.undecidedShare * static_cast<double>(count)) << call.name;
}

}  // namespace meniscus::test

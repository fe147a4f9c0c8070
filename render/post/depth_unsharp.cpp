#include "render/post/depth_unsharp.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec4.hpp>

#include "core/error.h"
#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

constexpr std::size_t kMostTaps = effects::kMostUnsharpTaps;
constexpr double kBlocksPerSigma = 3;  // error against the exact Gaussian below 0.01 of a step (tests/gpu)
constexpr double kTruncation = 3;      // standard deviations

// Blocks that a range of pixels touches.
int blockCount(int first, int count, int block) {
  return (first + count - 1) / block - first / block + 1;
}

}  // namespace

double unsharpSigma(const DepthUnsharpSettings& settings, const View& view) {
  double sigma = settings.radius * std::min(view.size.width, view.size.height);
  if (settings.radiusInAngstrom) {
    const double middle = view.distance - 0.5 * (view.nearZ + view.farZ);
    sigma = settings.radius / (view.pixelSize * (view.projection == Projection::perspective ? middle : 1.0));
  }
  return std::clamp(sigma, 0.0, kMaxUnsharpSigma);
}

UnsharpKernel unsharpKernel(double sigmaPixels) {
  UnsharpKernel kernel;
  kernel.block = std::max(1, static_cast<int>(sigmaPixels / kBlocksPerSigma));
  // A block's mean has the variance (b^2 - 1) / 12, interpolation between blocks (b^2 - 1) / 6 on average.
  const double block = kernel.block;
  const double variance = sigmaPixels * sigmaPixels - 0.25 * (block * block - 1);
  kernel.sigma = std::sqrt(std::max(variance, 0.0)) / block;
  kernel.taps =
      std::min(1 + static_cast<int>(std::ceil(kTruncation * kernel.sigma)), static_cast<int>(kMostTaps));
  return kernel;
}

void DepthUnsharpUniforms::set(const UnsharpKernel& kernel, const Tile& tile) {
  if (!buffer_.object) buffer_ = gl::Buffer::updatable(sizeof(effects::DepthUnsharpBlock));
  effects::DepthUnsharpBlock& block = block_;
  block.grid = {tile.x, tile.y, kernel.block, kernel.taps};
  double sum = 0;
  std::array<double, kMostTaps> taps{};
  for (int i = 0; i < kernel.taps; ++i) {
    const double x = kernel.sigma > 0 ? i / kernel.sigma : 0;
    taps[static_cast<std::size_t>(i)] = std::exp(-0.5 * x * x);
    sum += (i == 0 ? 1 : 2) * taps[static_cast<std::size_t>(i)];
  }
  for (std::size_t i = 0; i < kMostTaps; ++i) block.taps[i] = static_cast<float>(taps[i] / sum);
  buffer_.update(&block);
}

int reachOf(const DepthUnsharpSettings& settings, const View& view) {
  if (settings.mode == UnsharpMode::off) return 0;
  const UnsharpKernel kernel = unsharpKernel(unsharpSigma(settings, view));
  return kernel.block * (kernel.taps + 1);
}

TextureRef addDepthUnsharp(FrameGraph& graph, const UnsharpKernel& kernel,
                           const DepthUnsharpUniforms& uniforms, ShaderLibrary& shaders,
                           const GBufferRefs& gbuffer, const Tile& tile, SurfaceReader* reader) {
  if (reader != nullptr) {
    const TextureRef out = reader->createResult(graph, "depth difference", gl::TextureFormat::r32f);
    graph.addPass("depth unsharp", surfaceOf(gbuffer), {reader->attachment(out)},
                  [&uniforms, reader, gbuffer, out](const PassContext& context) {
                    unsharpDepth(reader->read(context, gbuffer), uniforms.block(), reader->difference);
                    reader->write(context, out, reader->difference);
                  });
    return out;
  }
  const gl::TextureDesc blocks{gl::TextureFormat::rg32f, blockCount(tile.x, tile.width, kernel.block),
                               blockCount(tile.y, tile.height, kernel.block)};
  const TextureRef sums = graph.create("depth blocks", blocks, Clear::none);
  const TextureRef across = graph.create("depth blurred across", blocks, Clear::none);
  const TextureRef blurred = graph.create("depth blurred", blocks, Clear::none);
  const TextureRef difference =
      graph.create("depth difference", {gl::TextureFormat::r32f, tile.width, tile.height});
  const auto addStep = [&](const char* name, const char* shader, std::vector<TextureRef> reads,
                           TextureRef write, const ShaderFlags& flags, bool overSurface = false) {
    std::vector<FrameGraph::Attachment> writes{{write, 0}};
    if (overSurface) writes.push_back({gbuffer.depth, FrameGraph::kTestedDepth});
    graph.addPass(name, reads, writes,
                  [&uniforms, &shaders, shader, reads, flags, overSurface](const PassContext& context) {
                    for (unsigned i = 0; i < reads.size(); ++i) {
                      glBindTextureUnit(i, context.texture(reads[i]).object.name());
                    }
                    glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.name());
                    const unsigned program = shaders.program("post/fullscreen.vert", shader, flags);
                    overSurface ? drawOverSurface(program) : drawFullscreen(program);
                  });
  };
  addStep("depth unsharp: blocks", "post/depth_unsharp_blocks.frag", {gbuffer.depth}, sums, {});
  addStep("depth unsharp: blur across", "post/depth_unsharp_blur.frag", {sums}, across, {});
  addStep("depth unsharp: blur up", "post/depth_unsharp_blur.frag", {across}, blurred, {"VERTICAL"});
  addStep("depth unsharp", "post/depth_unsharp.frag", {gbuffer.depth, blurred}, difference, {}, true);
  return difference;
}

}  // namespace meniscus

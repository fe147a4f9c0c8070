#include "render/post/occlusion.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <glm/vec2.hpp>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

using effects::OcclusionDirection;

constexpr int kGroup = 4;
constexpr int kBlock = effects::kOcclusionBlock;
constexpr int kTextureWidth = 1 << 12;  // as in shaders/post/occlusion.frag

// Layout of OcclusionUniforms in shaders/include/occlusion.glsl. Each begins where a uniform block may, which
// is at multiples of at most 256 bytes.
struct alignas(256) OcclusionBlock {
  glm::ivec4 part, parts;
  glm::vec4 slab, fade;
  std::array<OcclusionDirection, kGroup> directions;
};

OcclusionDirection directionOf(const OcclusionMap& map, const View& camera) {
  const View& view = map.view;
  const glm::dmat3 rows = glm::transpose(view.rotation * glm::transpose(camera.rotation));
  const glm::dvec3 shift = view.rotation * (camera.pivot - view.pivot);
  const double perTexel = 1 / view.pixelSize;
  return {glm::vec4(glm::dvec4(rows[0], shift.x) * perTexel + glm::dvec4(0, 0, 0, view.center.x)),
          glm::vec4(glm::dvec4(rows[1], shift.y) * perTexel + glm::dvec4(0, 0, 0, view.center.y)),
          glm::vec4(glm::dvec4(rows[2], shift.z - view.farZ)),
          {static_cast<int>(map.first), view.size.width, view.size.height, map.slabs}};
}

// The parts hold every fourth pixel each way; the first and the last block may lie partly outside.
glm::ivec2 partSize(int width, int height) {
  return glm::ivec2(width, height) / kBlock + 2;
}

}  // namespace

void OcclusionBuffers::set(const View& camera, OcclusionMaps maps, bool onProcessor) {
  MENISCUS_CHECK(!maps.maps.empty() && maps.maps.size() % (2 * kGroup) == 0);
  // Occluders count in full up to half the radius; without one, up to the farthest there can be.
  const double radius = maps.radius > 0 ? maps.radius : 2 * maps.slabHeight * maps.maps.front().slabs;
  const double fade = 2.0 / radius;
  look_.slab = glm::vec4(glm::dvec4(1 / maps.slabHeight, maps.reach, fade * maps.step, 1 / maps.step));
  look_.fade = glm::vec4(glm::dvec4(2.0, fade, 0.0, 2e-6 * maps.slabHeight * maps.maps.front().slabs));
  directions_.clear();
  for (const OcclusionMap& map : maps.maps) directions_.push_back(directionOf(map, camera));
  onProcessor_ = onProcessor;
  if (onProcessor) {
    heights_ = std::move(maps.texels);
    look_.texels = heights_;
  } else {
    upload(maps.texels);
  }
}

void OcclusionBuffers::clear() {
  texels_ = {};
  std::vector<OcclusionTexel>().swap(heights_);  // assignment might only empty it
  look_ = {};
}

std::uint64_t OcclusionBuffers::bytes() const {
  return texels_.bytes() + sizeof(OcclusionTexel) * heights_.size();
}

// A texture: llvmpipe fetches from buffers one value at a time.
void OcclusionBuffers::upload(const std::vector<OcclusionTexel>& texels) {
  const auto count = static_cast<int>(texels.size());
  const gl::TextureDesc desc{gl::TextureFormat::rgba32ui, kTextureWidth, count / kTextureWidth + 1};
  if (!texels_.object || texels_.desc != desc) texels_ = gl::Texture::make(desc);
  const auto send = [&](int row, int width, int height) {
    glTextureSubImage2D(texels_.object.name(), 0, 0, row, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        texels.data() + static_cast<std::size_t>(row) * kTextureWidth);
  };
  const int rows = count / kTextureWidth;
  if (rows > 0) send(0, kTextureWidth, rows);
  if (count % kTextureWidth > 0) send(rows, count % kTextureWidth, 1);
}

OcclusionShare occlusionShare(int directions, int sampleCount) {
  // At least eight: fewer would show at edges, where a pixel has few samples of a surface. Aligned blocks of
  // a power of two are evenly spread, each of them (core/occlusion_maps.h).
  const int eights = directions / 8;
  const int least = std::max(1, eights / std::max(sampleCount, 1));
  int count = static_cast<int>(std::bit_ceil(static_cast<unsigned>(least)));
  if (eights % count != 0) count = eights;
  OcclusionShare share;
  share.directions = 8 * count;
  // Eight or more samples smooth what they take by themselves.
  if (sampleCount < 8) share.parts = std::gcd(share.directions / kGroup, kBlock * kBlock);
  return share;
}

void OcclusionBuffers::chooseDirections(int sample, int sampleCount, const Tile& tile) {
  const auto all = static_cast<int>(directions_.size());
  const OcclusionShare share = occlusionShare(all, sampleCount);
  const auto first = directions_.begin() + sample % (all / share.directions) * share.directions;
  look_.directions.assign(first, first + share.directions);
  look_.parts = share.parts;
  look_.phase = {tile.x % kBlock, tile.y % kBlock};
  look_.fade.z = static_cast<float>(share.parts) / static_cast<float>(share.directions);
  if (!onProcessor_) setUniforms(tile);
}

void OcclusionBuffers::setUniforms(const Tile& tile) {
  const int perPart = static_cast<int>(look_.directions.size()) / look_.parts;
  OcclusionBlock block{};
  block.slab = look_.slab;
  block.fade = look_.fade;
  std::vector<OcclusionBlock> blocks;
  draws_.clear();
  const auto add = [&](int part) {
    for (int i = 0; i < perPart; i += kGroup) {
      for (int k = 0; k < kGroup; ++k)
        block.directions[static_cast<std::size_t>(k)] =
            look_.directions[static_cast<std::size_t>(part * perPart + i + k)];
      blocks.push_back(block);
    }
  };
  if (look_.parts == 1) {
    block.part = {0, 0, 1, 0};
    add(0);
    draws_ = {{0, 0, tile.width, tile.height, perPart / kGroup}};
  } else {
    const glm::ivec2 size = partSize(tile.width, tile.height);
    block.parts = {size, look_.phase};
    for (int y = 0; y < kBlock; ++y) {
      for (int x = 0; x < kBlock; ++x) {
        const glm::ivec2 corner = glm::ivec2(x, y) * size;
        block.part = {glm::ivec2(x, y) - look_.phase - kBlock * corner, kBlock, 0};
        add(effects::occlusionPartOf({x, y}, look_.parts));
        draws_.push_back({corner.x, corner.y, size.x, size.y, perPart / kGroup});
      }
    }
  }
  const std::uint64_t bytes = blocks.size() * sizeof(OcclusionBlock);
  if (uniforms_.bytes != bytes) uniforms_ = gl::Buffer::updatable(bytes);
  uniforms_.update(blocks.data());
}

void OcclusionBuffers::bindFirst() const {
  glBindBufferRange(GL_UNIFORM_BUFFER, 1, uniforms_.object.name(), 0, sizeof(OcclusionBlock));
}

void OcclusionBuffers::eachDraw(const std::function<void(bool)>& call) const {
  GLintptr offset = 0;
  for (const Draw& draw : draws_) {
    glViewport(draw.x, draw.y, draw.width, draw.height);
    for (int i = 0; i < draw.groups; ++i) {
      glBindBufferRange(GL_UNIFORM_BUFFER, 1, uniforms_.object.name(), offset, sizeof(OcclusionBlock));
      call(i == 0);
      offset += sizeof(OcclusionBlock);
    }
  }
}

void OcclusionBuffers::draw(ShaderLibrary& shaders) const {
  const GLuint program = shaders.program("post/fullscreen.vert", "post/occlusion.frag", {});
  glBindTextureUnit(2, texels_.object.name());
  eachDraw([program](bool first) { drawOverSurface(program, !first); });
}

// What is looked up skips the background by this depth, as other passes do by the G-buffer's.
void OcclusionBuffers::divideDepth(ShaderLibrary& shaders) const {
  const GLuint program = shaders.program("post/fullscreen.vert", "post/occlusion_depth.frag", {});
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  eachDraw([program](bool first) {
    if (first) drawFullscreen(program);
  });
  glDisable(GL_DEPTH_TEST);
}

int reachOf(const OcclusionSettings& settings, int sampleCount) {
  const bool shared = settings.on && occlusionShare(settings.directions, sampleCount).parts > 1;
  return shared ? effects::kOcclusionReach : 0;
}

TextureRef addOcclusion(FrameGraph& graph, const OcclusionBuffers& buffers, ShaderLibrary& shaders,
                        const GBufferRefs& gbuffer, int width, int height, SurfaceReader* reader) {
  using gl::TextureFormat;
  if (reader != nullptr) {
    const TextureRef result = reader->createResult(graph, "occlusion", TextureFormat::rg16);
    graph.addPass("occlusion", surfaceOf(gbuffer), {reader->attachment(result)},
                  [&buffers, reader, gbuffer, result](const PassContext& context) {
                    lookUpOcclusion(reader->read(context, gbuffer), buffers.look(), reader->occlusion);
                    reader->write(context, result, reader->occlusion);
                  });
    return result;
  }
  const TextureRef occlusion = graph.create("occlusion", {TextureFormat::rg16, width, height});
  const auto bindSurface = [gbuffer](const PassContext& context) {
    glBindTextureUnit(0, context.texture(gbuffer.depth).object.name());
    glBindTextureUnit(1, context.texture(gbuffer.normal).object.name());
  };
  const auto addLook = [&](TextureRef depth, TextureRef target) {
    graph.addPass("occlusion", {depth, gbuffer.depth, gbuffer.normal},
                  {{target, 0}, {depth, FrameGraph::kTestedDepth}},
                  [&buffers, &shaders, bindSurface](const PassContext& context) {
                    bindSurface(context);
                    buffers.draw(shaders);
                  });
  };
  if (buffers.parts() == 1) {
    addLook(gbuffer.depth, occlusion);
    return occlusion;
  }
  const glm::ivec2 size = kBlock * partSize(width, height);
  const TextureRef partDepth = graph.create("occlusion depth", {TextureFormat::depth32f, size.x, size.y});
  const TextureRef parts = graph.create("occlusion parts", {TextureFormat::rg16, size.x, size.y});
  const TextureRef rows = graph.create("occlusion rows", {TextureFormat::rg16, width, height});
  graph.addPass("occlusion depth", {gbuffer.depth}, {{partDepth, FrameGraph::kDepth}},
                [&buffers, &shaders, bindSurface](const PassContext& context) {
                  bindSurface(context);
                  buffers.divideDepth(shaders);
                });
  addLook(partDepth, parts);
  const auto addGather = [&](TextureRef sums, TextureRef target, const ShaderFlags& flags) {
    graph.addPass(
        "occlusion gather", {gbuffer.depth, gbuffer.normal, sums},
        {{target, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
        [&buffers, &shaders, bindSurface, sums, flags](const PassContext& context) {
          bindSurface(context);
          glBindTextureUnit(2, context.texture(sums).object.name());
          buffers.bindFirst();
          drawOverSurface(shaders.program("post/fullscreen.vert", "post/occlusion_gather.frag", flags));
        });
  };
  addGather(parts, rows, {});
  addGather(rows, occlusion, {"UP"});
  return occlusion;
}

}  // namespace meniscus

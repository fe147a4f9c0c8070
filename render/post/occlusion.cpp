#include "render/post/occlusion.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <glm/vec4.hpp>

#include "core/error.h"
#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

constexpr int kGroup = 8;
constexpr int kTextureWidth = 1 << 12;  // as in shaders/post/occlusion.frag

// Layout of OcclusionUniforms in shaders/post/occlusion.frag. Each begins where a uniform block may, which is
// at multiples of at most 256 bytes.
struct Direction {
  glm::vec4 rowX, rowY, rowZ;
  glm::ivec4 map;
};
struct alignas(256) OcclusionBlock {
  glm::vec4 slab, fade;
  std::array<Direction, kGroup> directions;
};

Direction directionOf(const OcclusionMap& map, const View& camera) {
  const View& view = map.view;
  const glm::dmat3 rows = glm::transpose(view.rotation * glm::transpose(camera.rotation));
  const glm::dvec3 shift = view.rotation * (camera.pivot - view.pivot);
  const double perTexel = 1 / view.pixelSize;
  return {glm::vec4(glm::dvec4(rows[0], shift.x) * perTexel + glm::dvec4(0, 0, 0, view.center.x)),
          glm::vec4(glm::dvec4(rows[1], shift.y) * perTexel + glm::dvec4(0, 0, 0, view.center.y)),
          glm::vec4(glm::dvec4(rows[2], shift.z - view.farZ)),
          {static_cast<int>(map.first), view.size.width, view.size.height, map.slabs}};
}

}  // namespace

void OcclusionBuffers::set(const View& camera, const OcclusionMaps& maps) {
  MENISCUS_CHECK(!maps.maps.empty() && maps.maps.size() % kGroup == 0);
  OcclusionBlock block{};
  block.slab = glm::vec4(glm::dvec4(1 / maps.slabHeight, maps.reach, maps.radius, maps.step));
  // Occluders count in full up to half the radius.
  const bool limited = maps.radius > 0;
  block.fade = glm::vec4(glm::dvec4(limited ? 2.0 : 1.0, limited ? 2.0 / maps.radius : 0.0,
                                    1.0 / static_cast<double>(maps.maps.size()),
                                    2e-6 * maps.slabHeight * maps.maps.front().slabs));
  std::vector<OcclusionBlock> blocks(maps.maps.size() / kGroup, block);
  for (std::size_t i = 0; i < maps.maps.size(); ++i)
    blocks[i / kGroup].directions[i % kGroup] = directionOf(maps.maps[i], camera);
  groups_ = static_cast<int>(blocks.size());
  uniforms_ = gl::Buffer::fromData(blocks.data(), blocks.size() * sizeof(OcclusionBlock));
  upload(maps.texels);
}

// A texture: llvmpipe fetches from buffers one value at a time.
void OcclusionBuffers::upload(const std::vector<std::uint32_t>& texels) {
  const auto count = static_cast<int>(texels.size());
  const gl::TextureDesc desc{gl::TextureFormat::r32ui, kTextureWidth, count / kTextureWidth + 1};
  if (!texels_.object || texels_.desc != desc) texels_ = gl::Texture::make(desc);
  const auto send = [&](int row, int width, int height) {
    glTextureSubImage2D(texels_.object.name(), 0, 0, row, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        texels.data() + static_cast<std::size_t>(row) * kTextureWidth);
  };
  const int rows = count / kTextureWidth;
  if (rows > 0) send(0, kTextureWidth, rows);
  if (count % kTextureWidth > 0) send(rows, count % kTextureWidth, 1);
}

void OcclusionBuffers::chooseDirections(int sample, int sampleCount) {
  // At least eight: fewer would show at edges, where a pixel has few samples of a surface. Aligned blocks of
  // a power of two are evenly spread, each of them (core/occlusion_maps.h).
  const int least = std::max(1, groups_ / std::max(sampleCount, 1));
  count_ = static_cast<int>(std::bit_ceil(static_cast<unsigned>(least)));
  if (groups_ % count_ != 0) count_ = groups_;
  first_ = sample % (groups_ / count_) * count_;
}

TextureRef addOcclusion(FrameGraph& graph, const OcclusionBuffers& buffers, ShaderLibrary& shaders,
                        const GBufferRefs& gbuffer, int width, int height) {
  const TextureRef occlusion = graph.create("occlusion", {gl::TextureFormat::rg16, width, height});
  graph.addPass("occlusion", {gbuffer.depth, gbuffer.normal}, {{occlusion, 0}},
                [&buffers, &shaders, gbuffer](const PassContext& context) {
                  glBindTextureUnit(0, context.texture(gbuffer.depth).object.name());
                  glBindTextureUnit(1, context.texture(gbuffer.normal).object.name());
                  glBindTextureUnit(2, buffers.texels_.object.name());
                  const GLuint program = shaders.program("post/fullscreen.vert", "post/occlusion.frag", {});
                  for (int i = buffers.first_; i < buffers.first_ + buffers.count_; ++i) {
                    glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffers.uniforms_.object.name(),
                                      static_cast<GLintptr>(i * sizeof(OcclusionBlock)),
                                      sizeof(OcclusionBlock));
                    drawFullscreen(program, true);
                  }
                });
  return occlusion;
}

}  // namespace meniscus

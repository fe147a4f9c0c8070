#include "render/post/labels.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/error.h"
#include "render/srgb.h"

namespace meniscus {

namespace {

// Layout of Places in shaders/post/label.vert.
struct LabelPlace {
  glm::ivec4 box;  // picture's pixels: lower left corner, size
  glm::ivec2 texel;
  float depth;  // as in the depth buffer
  float unused = 0;
};

// Layout of LabelUniforms there.
struct LabelBlock {
  glm::ivec4 tile;
  glm::vec4 text, seam;  // linear light
};

struct Shown {
  const LabelSprite* sprite;
  LabelPlace place;
};

// Where a label is seen; nothing if it is not.
bool place(const LabelSprite& sprite, const View& view, LabelPlace& out) {
  const bool perspective = view.projection == Projection::perspective;
  glm::dvec3 p = view.rotation * (sprite.label.center - view.pivot);
  const glm::dvec3 eye(0, 0, view.distance);
  const double far = perspective ? glm::length(eye - p) : 0;
  if (perspective && !(p.z < view.distance && far > 0)) return false;
  // The sphere's nearest point, but not before the near plane.
  p += perspective ? (eye - p) * std::min(sprite.label.radius / far, 0.999)
                   : glm::dvec3(0, 0, sprite.label.radius);
  if (view.cutsFar && p.z <= view.farZ) return false;
  const double span = view.nearZ - view.farZ;
  p.z = std::min(p.z, view.nearZ - 1e-6 * span);
  const double depth = perspective ? view.distance - p.z : 1.0;
  const glm::dvec2 pixel = view.center + glm::dvec2(p) / (depth * view.pixelSize);
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x <= view.size.width && pixel.y <= view.size.height))
    return false;
  const auto corner = [](double middle, int size, int room) {
    return std::clamp(static_cast<int>(std::lround(middle - 0.5 * size)), 0, std::max(room - size, 0));
  };
  out.box = {corner(pixel.x, sprite.width, view.size.width), corner(pixel.y, sprite.height, view.size.height),
             sprite.width, sprite.height};
  const double factor = (perspective ? view.distance - view.nearZ : 1.0) / span;  // as in view_block.cpp
  out.depth = static_cast<float>(std::max((p.z - view.farZ) * factor / depth, 1e-30));
  return true;
}

}  // namespace

void LabelBuffers::set(const std::vector<LabelSprite>& sprites, const LabelColors& colors, const View& view) {
  count_ = 0;
  std::vector<Shown> shown;
  for (const LabelSprite& sprite : sprites) {
    LabelPlace at{};
    if (place(sprite, view, at)) shown.push_back({&sprite, at});
  }
  if (shown.empty()) return;
  // What is nearer covers what is farther away.
  std::stable_sort(shown.begin(), shown.end(),
                   [](const Shown& a, const Shown& b) { return a.place.depth < b.place.depth; });
  int width = 1024;
  for (const Shown& s : shown) width = std::max(width, s.sprite->width);
  int x = 0, y = 0, shelf = 0;
  for (Shown& s : shown) {
    if (x + s.sprite->width > width) {
      x = 0;
      y += shelf;
      shelf = 0;
    }
    s.place.texel = {x, y};
    x += s.sprite->width;
    shelf = std::max(shelf, s.sprite->height);
    if (y + shelf > gl::queryLimits().textureSize)
      throw InputError("there are more labels than fit into a texture; show fewer, or smaller ones");
  }
  atlas_ = gl::Texture::make({gl::TextureFormat::rg16, width, y + shelf});
  std::vector<LabelPlace> places;
  std::vector<std::uint16_t> texels;
  for (const Shown& s : shown) {
    const LabelSprite& sprite = *s.sprite;
    texels.clear();
    for (int row = sprite.height; row-- > 0;) {  // textures begin at the bottom
      for (int column = 0; column < sprite.width; ++column) {
        const LabelTexel& t =
            sprite.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(sprite.width) +
                          static_cast<std::size_t>(column)];
        texels.push_back(static_cast<std::uint16_t>(257 * t.text));
        texels.push_back(static_cast<std::uint16_t>(257 * t.seam));
      }
    }
    atlas_.write(sprite.width, sprite.height, texels.data(), s.place.texel.x, s.place.texel.y);
    places.push_back(s.place);
  }
  places_ = gl::Buffer::fromData(places.data(), places.size() * sizeof(LabelPlace));
  if (!uniforms_.object) uniforms_ = gl::Buffer::updatable(sizeof(LabelBlock));
  colors_ = colors;
  count_ = static_cast<int>(places.size());
}

TextureRef addLabels(FrameGraph& graph, LabelBuffers& labels, ShaderLibrary& shaders,
                     const GBufferRefs& gbuffer, const Tile& tile) {
  const LabelBlock block{{tile.x, tile.y, tile.width, tile.height},
                         linearColor(labels.colors_.text, 1),
                         linearColor(labels.colors_.seam, 1)};
  labels.uniforms_.update(&block);
  const TextureRef target = graph.create("labels", {gl::TextureFormat::rgba16, tile.width, tile.height});
  graph.addPass("labels", {gbuffer.depth}, {{target, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
                [&labels, &shaders](const PassContext&) {
                  GLuint vertexArray = 0;  // without attributes
                  glCreateVertexArrays(1, &vertexArray);
                  glBindVertexArray(vertexArray);
                  glUseProgram(shaders.program("post/label.vert", "post/label.frag", {}));
                  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, labels.places_.object.name());
                  glBindBufferBase(GL_UNIFORM_BUFFER, 1, labels.uniforms_.object.name());
                  glBindTextureUnit(0, labels.atlas_.object.name());
                  glEnable(GL_BLEND);
                  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
                  glEnable(GL_DEPTH_TEST);
                  glDepthMask(GL_FALSE);
                  glDepthFunc(GL_GREATER);
                  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, labels.count_);
                  glDepthMask(GL_TRUE);
                  glDisable(GL_DEPTH_TEST);
                  glDisable(GL_BLEND);
                  glDeleteVertexArrays(1, &vertexArray);
                });
  return target;
}

}  // namespace meniscus

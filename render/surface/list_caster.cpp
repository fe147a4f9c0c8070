#include "render/surface/list_caster.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

// Beyond so many supports from a pixel's first ball the ends of a chord are off by 2e-5 of the support.
constexpr float kTrustedSupports = 256;
// A ball alone whose maximum is so near the level (as a share of it) is met as a sphere, which only
// shaders/surface/lists_walk.frag does.
constexpr double kNearMaximum = 1e-3;

// ListsUniforms of shaders/include/lists.glsl.
struct ListsBlock {
  glm::vec4 settings;
  glm::ivec4 region, lists, grid;
};

// Control of shaders/include/lists_trace.glsl.
struct ListsControl {
  std::uint32_t unanswered, exhausted;
};

}  // namespace

ListCaster::ListCaster(std::string method, double tolerance, int array, bool exact)
    : method_(std::move(method)), tolerance_(static_cast<float>(tolerance)), array_(array), exact_(exact) {}

void ListCaster::prepare(const MetaballField& field) {
  kernelFlags_ = exact_ ? kernelFlags(field.kernel) : ShaderFlags{"CUBIC"};
  walkAll_ =
      exact_ && std::any_of(field.balls.begin(), field.balls.end(), [&](const Metaball& ball) {
        return std::abs(static_cast<double>(ball.coefficient) - field.level) < kNearMaximum * field.level;
      });
  uniforms_ = gl::Buffer::updatable(sizeof(ListsBlock));
  control_.reserve(sizeof(ListsControl));
  statistics_.counts.prepare();
}

ShaderFlags ListCaster::flags(bool translucent) const {
  ShaderFlags flags = kernelFlags_;
  if (translucent) flags.insert("LAYERS");
  return flags;
}

ListRegion ListCaster::begin(const ListTarget& target, const ScreenRect& rect) {
  TexturePool& pool = target.context.pool();
  const auto lease = [&](const char* name, gl::TextureFormat format) {
    return pool.lease(name, {format, rect.width, rect.height});
  };
  ListRegion region{rect, lease("surface: cores", gl::TextureFormat::depth32f),
                    TextureLease(nullptr, ReturnToPool{})};
  if (!target.translucent()) region.places = lease("surface: places", gl::TextureFormat::rg32f);
  heads_.reserve(static_cast<std::uint64_t>(rect.pixels()) * 4);
  heads_.zero();
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, uniforms_.object.name());
  heads_.bindStorage(2);
  control_.bindStorage(4);
  statistics_.counts.bindStorage(5);
  setUniforms(target, rect, 0);
  return region;
}

void ListCaster::setUniforms(const ListTarget& target, const ScreenRect& region, std::int64_t nodes,
                             bool goOn) {
  ListsBlock block;
  block.settings = {target.placeScale, tolerance_, walkAll_ ? -1.0f : kTrustedSupports, 0.0f};
  block.region = {region.x, region.y, region.width, region.height};
  block.lists = {array_, static_cast<int>(nodes), goOn || target.layersBefore.valid() ? 1 : 0, 2};
  block.grid = grid_;
  uniforms_.update(&block);
}

void ListCaster::clearCores(const ListTarget& target, const ListRegion& region) const {
  const float farthest = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, target.context.pool().framebuffer({}, region.cores.get()));
  glViewport(0, 0, region.rect.width, region.rect.height);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void ListCaster::layHidden(const ListTarget& target) const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glBindTextureUnit(0, target.context.texture(target.gbuffer.depth).object.name());
  drawFullscreen(target.shaders.program("post/fullscreen.vert", "surface/lists_hidden.frag", {}));
  glDisable(GL_DEPTH_TEST);
}

void ListCaster::draw(const ListTarget& target, const ListRegion& region, const ScreenRect& part,
                      std::int64_t nodes) {
  cast(target, region, part, nodes);
  if (!target.translucent()) shade(target, region, part);
}

void ListCaster::cast(const ListTarget& target, const ListRegion& region, const ScreenRect& part,
                      std::int64_t nodes) {
  ScreenRect drawn = part;
  if (target.translucent()) {
    target.context.bindTarget();
    drawn.x += region.rect.x;
    drawn.y += region.rect.y;
    glBindTextureUnit(4, target.context.texture(target.gbuffer.depth).object.name());
    if (target.layersBefore.valid()) {
      for (std::size_t i = 0; i < target.layersBefore.of.size(); ++i)
        glBindTextureUnit(7 + static_cast<GLuint>(i),
                          target.context.texture(target.layersBefore.of[i]).object.name());
    }
  } else {
    glBindFramebuffer(GL_FRAMEBUFFER, target.context.pool().framebuffer({region.places.get()}, nullptr));
    glViewport(0, 0, region.rect.width, region.rect.height);
  }
  control_.zero();
  glBindTextureUnit(0, region.cores->object.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(drawn.x, drawn.y, drawn.width, drawn.height);
  drawFullscreen(target.shaders.program("post/fullscreen.vert", "surface/lists_cast.frag", target.flags));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  ListsControl control{};
  control_.read(&control, sizeof control);
  if (control.unanswered > 0) {
    setUniforms(target, region.rect, nodes, target.translucent());
    walk(target, region);
  }
  glDisable(GL_SCISSOR_TEST);
}

// Pixels that the cast could not answer, each for some pieces at a time.
void ListCaster::walk(const ListTarget& target, const ListRegion& region) {
  states_.reserve(static_cast<std::uint64_t>(region.rect.pixels()) * 16);
  states_.zero();
  states_.bindStorage(6);
  if (target.translucent()) {  // each texel is read and written by the same fragment: OpenGL 4.5, 9.3.1
    for (std::size_t i = 0; i < target.layers.of.size(); ++i)
      glBindTextureUnit(7 + static_cast<GLuint>(i),
                        target.context.texture(target.layers.of[i]).object.name());
  }
  const unsigned program =
      target.shaders.program("post/fullscreen.vert", "surface/lists_walk.frag", target.flags);
  ListsControl control{1, 0};
  while (control.unanswered > 0) {
    control_.zero();
    glTextureBarrier();
    drawFullscreen(program);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    control_.read(&control, sizeof control);
    checkLoops(method_, control.exhausted);
  }
}

void ListCaster::shade(const ListTarget& target, const ListRegion& region, const ScreenRect& part) {
  target.context.bindTarget();
  ShaderFlags flags = channelFlags(target.context, target.gbuffer);
  if (target.flags.contains("TILES")) flags.insert("TILES");
  glBindTextureUnit(0, region.places->object.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glEnable(GL_SCISSOR_TEST);
  glScissor(region.rect.x + part.x, region.rect.y + part.y, part.width, part.height);
  drawFullscreen(target.shaders.program("surface/near_plane.vert", "surface/lists_surface.frag", flags));
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace meniscus

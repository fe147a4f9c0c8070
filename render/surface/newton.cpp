#include "render/surface/newton.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/gl/storage.h"
#include "render/post/fullscreen.h"
#include "render/surface/newton_field.h"
#include "render/surface/peel_regions.h"
#include "render/surface/projected_field.h"
#include "render/surface/ray_counts.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kNewtonParameters[] = {
    {"tolerance", "a step of Newton's method shorter than this share of the ball's support is the last", 1e-5,
     1e-7, 0.1, false},
    {"safeguard", "1: the first root, bracketed; 0: as the poster does, from where the hull is entered", 1, 0,
     1, true},
    {"terms", "how many terms of the field are added exactly, the largest; 0: all", 0, 0, 32, true},
    {"ambient", "cells along the longest side of the texture with the rest of them; 0: it is left out", 64, 0,
     256, true},
    {"iterations", "of the poster's iteration, at most", 8, 1, 64, true},
    {"debug", "1: pixels that the poster's iteration fails in are magenta; 0: they are holes", 1, 0, 1, true},
};

// Textures for so many pixels at once.
constexpr std::int64_t kBandPixels = std::int64_t{8} << 20;

// NewtonUniforms of shaders/include/newton.glsl.
struct NewtonBlock {
  glm::vec4 turn[3];
  glm::vec4 solver;
  glm::ivec4 terms;
  glm::vec4 ambient;
  glm::ivec4 ambientTo;
};

// Of shaders/surface/newton.vert.
struct HullInstance {
  glm::vec4 box, pixel, place, eye, center;
  glm::vec2 hull;
  glm::uvec4 lists;
};

// Sums of shaders/include/sums.glsl, of which overflow stays zero.
struct NewtonCounts {
  RayCounts common;
};

class Newton : public SurfaceMethod {
 public:
  explicit Newton(const SurfaceParameters& values)
      : tolerance_(values.at("tolerance")),
        terms_(static_cast<int>(values.at("terms"))),
        ambientCells_(static_cast<int>(values.at("ambient"))),
        iterations_(static_cast<int>(values.at("iterations"))),
        plain_(values.at("safeguard") == 0),
        debug_(plain_ && values.at("debug") != 0) {}

  void prepare(const MetaballField& field) override;
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override;
  std::vector<ResourceStats> buffers() const override;
  std::uint64_t bytesOfBalls() const override;

 private:
  struct Frame {
    const PassContext& context;
    ShaderLibrary& shaders;
    GBufferRefs gbuffer;
    ScreenRect screen;
    int hulls = 0, nearHulls = 0;  // the latter last among the instances
    ShaderFlags kernel;
  };
  struct Band {
    ScreenRect rect;
    TextureLease status, failures, limit, near, rank, at, depth;
  };

  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);
  void uploadInstances(Frame& frame, const ProjectedField& projected, const View& view);
  void setUniforms(const View& view, const ProjectedField& projected, bool mayBeginInside);
  void drawBand(const Frame& frame, const ScreenRect& rect);
  void drawNear(const Frame& frame, Band& band);
  void drawLimit(const Frame& frame, Band& band);
  void drawHulls(const Frame& frame, const Band& band);
  void finish(const Frame& frame, const Band& band);
  void drawInstances(const ScreenRect& band, int first, int count) const;
  void setArea(const ScreenRect& band) const;

  double tolerance_;
  int terms_, ambientCells_, iterations_;
  bool plain_, debug_;
  bool culls_ = false;  // whether cores hide what lies behind them
  const MetaballField* field_ = nullptr;
  std::vector<float> coreShares_;
  NewtonField textures_;
  gl::Object vertexArray_;
  gl::Storage instances_;
  RayCountCopies<NewtonCounts> counts_;
  gl::Buffer fieldUniforms_, newtonUniforms_;
  double hullsDrawn_ = 0, mostBytesPerPixel_ = 0;
};

void Newton::prepare(const MetaballField& field) {
  field_ = &field;
  culls_ = !plain_ && field.allPositive();
  coreShares_ = coreShares(field);
  textures_.prepare(field, terms_, ambientCells_, plain_);

  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  vertexArray_ = gl::Object(gl::ObjectKind::vertexArray, name);
  glVertexArrayBindingDivisor(name, 0, 1);
  const std::pair<GLint, std::size_t> floats[] = {
      {4, offsetof(HullInstance, box)},    {4, offsetof(HullInstance, pixel)},
      {4, offsetof(HullInstance, place)},  {4, offsetof(HullInstance, eye)},
      {4, offsetof(HullInstance, center)}, {2, offsetof(HullInstance, hull)}};
  GLuint location = 0;
  for (const auto& [count, offset] : floats) {
    glEnableVertexArrayAttrib(name, location);
    glVertexArrayAttribFormat(name, location, count, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(name, location++, 0);
  }
  glEnableVertexArrayAttrib(name, location);
  glVertexArrayAttribIFormat(name, location, 4, GL_UNSIGNED_INT, offsetof(HullInstance, lists));
  glVertexArrayAttribBinding(name, location, 0);
  fieldUniforms_ = gl::Buffer::updatable(sizeof(FieldBlock));
  newtonUniforms_ = gl::Buffer::updatable(sizeof(NewtonBlock));
  counts_.prepare();
}

void Newton::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  graph.addPass(target.prefix + "surface", {target.gbuffer.depth}, attachmentsOf(target.gbuffer),
                [this, &shaders, target](const PassContext& context) { draw(context, shaders, target); });
}

void Newton::draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target) {
  const ProjectedField projected = projectField(*field_, coreShares_, target.view, target.origin, target.tile,
                                                target.sampleShift, BallOrder::depth);
  if (projected.balls.empty()) return;
  Frame frame{context,
              shaders,
              target.gbuffer,
              {0, 0, target.tile.width, target.tile.height},
              0,
              0,
              kernelFlags(field_->kernel)};
  uploadInstances(frame, projected, target.view);
  setUniforms(target.view, projected, frame.nearHulls > 0);
  for (const ScreenRect& rect : splitRect(frame.screen, kBandPixels)) drawBand(frame, rect);
  context.bindTarget();
}

// Once for their hulls; those that the near plane cuts once more.
void Newton::uploadInstances(Frame& frame, const ProjectedField& projected, const View& view) {
  std::vector<HullInstance> instances, near;
  const double plane = static_cast<double>(projected.block.plane.x);
  for (std::size_t i = 0; i < projected.balls.size(); ++i) {
    const ProjectedBall& ball = projected.balls[i];
    const std::uint32_t rank = textures_.rankOf[projected.indices[i]];
    const BallOverlaps& overlaps = textures_.overlaps;
    // Rounded up by an amount that no depth test notices.
    const double front = plane - projected.depths[i].x;
    const HullInstance instance{
        projected.boxes[i],
        ball.pixel,
        ball.place,
        ball.eye,
        glm::vec4(field_->balls[projected.indices[i]].center,
                  static_cast<float>(front + 1e-6 * std::abs(front))),
        {textures_.hulls[rank], ball.coefficient},
        {rank, overlaps.first[rank], overlaps.smaller[rank], overlaps.of(rank).size()}};
    instances.push_back(instance);
    if (front >= view.nearZ - 1e-6 * std::abs(view.nearZ)) near.push_back(instance);
  }
  frame.hulls = static_cast<int>(instances.size());
  frame.nearHulls = static_cast<int>(near.size());
  hullsDrawn_ += frame.hulls;
  instances.insert(instances.end(), near.begin(), near.end());
  instances_.reserve(instances.size() * sizeof(HullInstance));
  instances_.write(instances.data(), instances.size() * sizeof(HullInstance));
  glVertexArrayVertexBuffer(vertexArray_.name(), 0, instances_.name(), 0, sizeof(HullInstance));
  textures_.uploadProjected(projected);
}

void Newton::setUniforms(const View& view, const ProjectedField& projected, bool mayBeginInside) {
  NewtonBlock block{};
  const glm::dmat3 rows = glm::transpose(view.rotation);
  for (int i = 0; i < 3; ++i) block.turn[i] = glm::vec4(glm::vec3(rows[i]), 0);
  block.solver = {static_cast<float>(tolerance_), 0, 0, 0};
  block.terms = {terms_, iterations_, mayBeginInside ? 1 : 0, debug_ ? 1 : 0};
  block.ambient = glm::vec4(textures_.ambientBase, 1 / textures_.ambientSpacing);
  block.ambientTo = glm::ivec4(textures_.ambientNodes - 1, textures_.ambient ? 1 : 0);
  newtonUniforms_.update(&block);
  fieldUniforms_.update(&projected.block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, fieldUniforms_.object.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, newtonUniforms_.object.name());
  counts_.bindStorage(5);
}

void Newton::drawBand(const Frame& frame, const ScreenRect& rect) {
  Band band;
  band.rect = rect;
  TexturePool& pool = frame.context.pool();
  const GLuint zero = 0;
  double bytes = 16;
  const auto lease = [&](const char* name, gl::TextureFormat format) {
    return pool.lease(name, {format, rect.width, rect.height});
  };
  band.status = lease("surface: status", gl::TextureFormat::r32ui);
  glClearTexImage(band.status->object.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  band.rank = lease("surface: balls of hits", gl::TextureFormat::r32ui);
  band.at = lease("surface: places of hits", gl::TextureFormat::r32f);
  band.depth = lease("surface: depth of hits", gl::TextureFormat::depth32f);
  if (plain_) {
    band.failures = lease("surface: failures", gl::TextureFormat::r32ui);
    glClearTexImage(band.failures->object.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    bytes += 4;
  }
  if (frame.nearHulls > 0) {
    band.near = lease("surface: field at the start", gl::TextureFormat::r32f);
    drawNear(frame, band);
    bytes += 4;
  }
  if (!plain_) {
    band.limit = lease("surface: what hides it", gl::TextureFormat::depth32f);
    drawLimit(frame, band);
    bytes += 4;
  }
  mostBytesPerPixel_ = std::max(mostBytesPerPixel_, bytes);
  drawHulls(frame, band);
  finish(frame, band);
}

void Newton::setArea(const ScreenRect& band) const {
  glUniform4f(0, static_cast<float>(band.x), static_cast<float>(band.y), static_cast<float>(band.width),
              static_cast<float>(band.height));
}

void Newton::drawInstances(const ScreenRect& band, int first, int count) const {
  setArea(band);
  glBindVertexArray(vertexArray_.name());
  glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, count, static_cast<GLuint>(first));
}

void Newton::drawNear(const Frame& frame, Band& band) {
  const GLfloat zero[4] = {0, 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER, frame.context.pool().framebuffer({band.near.get()}, nullptr));
  glViewport(0, 0, band.rect.width, band.rect.height);
  glClearBufferfv(GL_COLOR, 0, zero);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(frame.shaders.program("surface/newton.vert", "surface/newton_prepare.frag", {}));
  drawInstances(band.rect, frame.hulls, frame.nearHulls);
  glDisable(GL_BLEND);
}

// What is in the G-buffer, and the cores in front of it.
void Newton::drawLimit(const Frame& frame, Band& band) {
  glCopyImageSubData(frame.context.texture(frame.gbuffer.depth).object.name(), GL_TEXTURE_2D, 0, band.rect.x,
                     band.rect.y, 0, band.limit->object.name(), GL_TEXTURE_2D, 0, 0, 0, 0, band.rect.width,
                     band.rect.height, 1);
  if (!culls_) return;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.context.pool().framebuffer({}, band.limit.get()));
  glViewport(0, 0, band.rect.width, band.rect.height);
  if (band.near) glBindTextureUnit(0, band.near->object.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glUseProgram(frame.shaders.program("surface/newton.vert", "surface/newton_prepare.frag", {"CORES"}));
  drawInstances(band.rect, 0, frame.hulls);
  glDisable(GL_DEPTH_TEST);
}

void Newton::drawHulls(const Frame& frame, const Band& band) {
  const GLuint none[4] = {0, 0, 0, 0};
  const GLfloat farthest = 0;
  glBindFramebuffer(GL_FRAMEBUFFER,
                    frame.context.pool().framebuffer({band.rank.get(), band.at.get()}, band.depth.get()));
  glViewport(0, 0, band.rect.width, band.rect.height);
  glClearBufferuiv(GL_COLOR, 0, none);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  ShaderFlags flags = frame.kernel;
  if (plain_) flags.insert("PLAIN");
  if (terms_ > 0) flags.insert("TERMS");
  textures_.bind();
  if (band.limit) glBindTextureUnit(4, band.limit->object.name());
  if (band.near) glBindTextureUnit(5, band.near->object.name());
  glBindImageTexture(0, band.status->object.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  if (plain_) glBindImageTexture(1, band.failures->object.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glUseProgram(frame.shaders.program("surface/newton.vert", "surface/newton_hull.frag", flags));
  drawInstances(band.rect, 0, frame.hulls);
  glDisable(GL_DEPTH_TEST);
}

void Newton::finish(const Frame& frame, const Band& band) {
  // What the hulls' images hold is read here, cleared by the next band, and the pool may give the textures
  // away as attachments.
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  frame.context.bindTarget();
  textures_.bind();
  glBindTextureUnit(4, band.status->object.name());
  glBindTextureUnit(5, band.rank->object.name());
  glBindTextureUnit(6, band.at->object.name());
  if (band.near) glBindTextureUnit(7, band.near->object.name());
  if (band.failures) glBindTextureUnit(8, band.failures->object.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(band.rect.x, band.rect.y, band.rect.width, band.rect.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  const unsigned program = frame.shaders.program("surface/near_plane.vert", "surface/newton_finish.frag",
                                                 channelFlags(frame.context, frame.gbuffer));
  glUseProgram(program);
  setArea(band.rect);
  drawFullscreen(program);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

SurfaceStats Newton::takeStats() {
  SurfaceStats stats;
  stats.method = plain_ ? "newton (plain)" : "newton";
  double hits = 0;
  for (const NewtonCounts& c : counts_.take(stats)) hits += c.common.hits;
  stats.details = {{"hits", hits},
                   {"hulls drawn", hullsDrawn_},
                   {"pairs that overlap", static_cast<double>(textures_.overlaps.others.size() / 2)},
                   {"most bytes per pixel", mostBytesPerPixel_}};
  hullsDrawn_ = mostBytesPerPixel_ = 0;
  return stats;
}

std::uint64_t Newton::bytesOfBalls() const {
  return textures_.bytes() + instances_.bytes();
}

std::vector<ResourceStats> Newton::buffers() const {
  return {{"surface: balls", textures_.bytes()},
          {"surface: hulls", instances_.bytes()},
          {"surface: sums", counts_.bytes()}};
}

}  // namespace

std::span<const SurfaceParameter> newtonParameters() {
  return kNewtonParameters;
}

std::unique_ptr<SurfaceMethod> makeNewton(const SurfaceParameters& values) {
  return std::make_unique<Newton>(values);
}

}  // namespace meniscus

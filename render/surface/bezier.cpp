#include "render/surface/bezier.h"

#include <glad/gl.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "render/gl/storage.h"
#include "render/surface/ball_texture.h"
#include "render/surface/bezier_statistics.h"
#include "render/surface/peel_regions.h"
#include "render/surface/projected_field.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kBezierParameters[] = {
    {"tolerance", "width to which a root is narrowed down, as a share of the smallest support around it",
     1e-5, 1e-7, 0.1, false},
    {"list", "ids that a pixel's list can hold", 14, 1, 1024, true},
    {"repair", "1: pixels whose list is too short go on without one; 0: as the paper does", 1, 0, 1, true},
    {"culling", "1: balls behind the cores of others are not drawn (only if no coefficient is negative)", 1,
     0, 1, true},
    {"tiles", "side of the grid of screen tiles that are peeled each for itself; 0: the screen is one", 16, 0,
     256, true},
    {"clipping", "1: Bezier clipping; 0: halving", 1, 0, 1, true},
};

// Storage blocks end at 128 MiB on the reference driver.
constexpr std::int64_t kListBytes = std::int64_t{96} << 20;
constexpr int kHeaderSlots = 5;  // shaders/include/bezier_lists.glsl
// Of 0x20000000 steps on either side some are left out (shaders/include/bezier.glsl).
constexpr double kSteps = 5.2e8;

// BezierUniforms of shaders/include/bezier.glsl.
struct BezierBlock {
  glm::vec4 steps;
  glm::ivec4 region, list;
};

// Control of shaders/include/bezier_pixel.glsl: pixels for which the driver ended a loop, and then its cells.
using PeelControl = std::uint32_t;

// Cell of shaders/include/bezier_pixel.glsl.
struct CellState {
  std::uint32_t unfinished, waiting, least, walks;
};

// CellBall of shaders/include/bezier_balls.glsl.
struct CellBall {
  std::uint32_t ball, begins;
};
constexpr std::uint32_t kBehindAll = 0xFFFFFFFFu;

// Balls of a cell that are drawn at first; twice as many whenever a pixel waits for more.
constexpr int kFirstWindow = 32;
// Layers after which pixels go on without lists: there are few left of them, which layers cost most for.
constexpr int kMostLayers = 64;
// Every so many layers it is found out which balls all pixels have passed.
constexpr int kLeastPeriod = 8;

// Textures and framebuffers of one region.
struct RegionTargets {
  TextureLease events, eventKeys, lastSteps, lastKeys;
  unsigned peel, coresOnly, step;
};

class Bezier : public SurfaceMethod {
 public:
  explicit Bezier(const SurfaceParameters& values)
      : tolerance_(values.at("tolerance")),
        list_(static_cast<int>(values.at("list"))),
        tiles_(static_cast<int>(values.at("tiles"))),
        repair_(values.at("repair") != 0),
        culling_(values.at("culling") != 0),
        clipping_(values.at("clipping") != 0) {}

  void prepare(const MetaballField& field) override;
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override { return statistics_.take(); }
  std::vector<ResourceStats> buffers() const override;
  std::uint64_t bytesOfBalls() const override;

 private:
  // What is the same for all regions of a target.
  struct Frame {
    const PassContext& context;
    ShaderLibrary& shaders;
    GBufferRefs gbuffer;
    const View& view;
    Tile tile;
    ScreenRect screen;
    ProjectedField projected;
    ShaderFlags flags;
    std::vector<bool> left;  // of each ball: whether culling left it anywhere
  };
  // What is being drawn of it.
  struct Region {
    ScreenRect rect;
    RegionTargets targets;
    std::vector<PeelCell> cells;
    std::vector<PeelInstance> instances;
    double step;  // length of a step on the ray [Å]
    std::vector<PeelWindow> windows;
    std::vector<StretchRange> stretches;
    std::vector<std::size_t> active;  // cells
    std::vector<StepInstance> steps;
    std::vector<std::uint32_t> blocks;  // as shaders/include/bezier_pixel.glsl marks them
    std::vector<CellState> states;      // of the cells
    int layer = 0;
    bool measured = false;
    std::vector<std::int32_t> walkFrom;  // of each cell with pixels that keep no list: its first CellBall
  };

  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);
  void drawRegion(Frame& frame, const ScreenRect& rect);
  void setUniforms(const Region& region);
  void uploadInstances(const Region& region);
  void cull(Frame& frame, Region& region);
  void peel(Frame& frame, Region& region);
  void listUnfinished(const Frame& frame, Region& region);
  void moveWindows(const Frame& frame, Region& region);
  void peelLayer(Frame& frame, const Region& region);
  void step(Frame& frame, const Region& region);
  void drawSteps(const Region& region, unsigned program);
  void readStates(Region& region);
  void walk(Frame& frame, Region& region);
  void uploadCellBalls(const Frame& frame, Region& region);
  int firstNotPassed(const Frame& frame, const Region& region, std::size_t cell, std::uint32_t least) const;
  void shade(Frame& frame, const Region& region);
  void drawCells(const Region& region, const std::vector<PeelCell>& cells) const;
  void scissorTo(const PeelCell& cell, const ScreenRect& corner) const;

  double tolerance_;
  int list_, tiles_;
  bool repair_, culling_, clipping_;
  const MetaballField* field_ = nullptr;
  std::vector<float> coreShares_;
  gl::Object vertexArray_, stepArray_;
  gl::Storage instances_, steps_, blocks_, balls_, lists_, control_, seen_, cellBalls_;
  BezierStatistics statistics_;
  BallTexture ballTexture_{sizeof(ProjectedBall) / 16};  // tBalls of shaders/include/field.glsl
  gl::Buffer fieldUniforms_, bezierUniforms_;
};

}  // namespace

std::span<const SurfaceParameter> bezierParameters() {
  return kBezierParameters;
}

std::unique_ptr<SurfaceMethod> makeBezier(const SurfaceParameters& values) {
  return std::make_unique<Bezier>(values);
}

namespace {

void Bezier::prepare(const MetaballField& field) {
  field_ = &field;
  coreShares_ = coreShares(field);
  culling_ = culling_ && field.allPositive();

  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  vertexArray_ = gl::Object(gl::ObjectKind::vertexArray, name);
  glVertexArrayBindingDivisor(name, 0, 1);
  const std::size_t offsets[] = {offsetof(PeelInstance, box), offsetof(PeelInstance, pixel),
                                 offsetof(PeelInstance, place), offsetof(PeelInstance, eye)};
  for (GLuint i = 0; i < 4; ++i) {
    glEnableVertexArrayAttrib(name, i);
    glVertexArrayAttribFormat(name, i, 4, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offsets[i]));
    glVertexArrayAttribBinding(name, i, 0);
  }
  glEnableVertexArrayAttrib(name, 4);
  glVertexArrayAttribIFormat(name, 4, 2, GL_UNSIGNED_INT, offsetof(PeelInstance, ball));
  glVertexArrayAttribBinding(name, 4, 0);

  glCreateVertexArrays(1, &name);
  stepArray_ = gl::Object(gl::ObjectKind::vertexArray, name);
  glVertexArrayBindingDivisor(name, 0, 1);
  glEnableVertexArrayAttrib(name, 0);
  glVertexArrayAttribFormat(name, 0, 4, GL_FLOAT, GL_FALSE, offsetof(StepInstance, box));
  glVertexArrayAttribBinding(name, 0, 0);
  glEnableVertexArrayAttrib(name, 1);
  glVertexArrayAttribIFormat(name, 1, 2, GL_INT, offsetof(StepInstance, cell));
  glVertexArrayAttribBinding(name, 1, 0);

  fieldUniforms_ = gl::Buffer::updatable(sizeof(FieldBlock));
  bezierUniforms_ = gl::Buffer::updatable(sizeof(BezierBlock));
  statistics_.counts.prepare();
}

void Bezier::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  graph.addPass(target.prefix + "surface", {target.gbuffer.depth}, attachmentsOf(target.gbuffer),
                [this, &shaders, target](const PassContext& context) { draw(context, shaders, target); });
}

void Bezier::draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target) {
  Frame frame{context,
              shaders,
              target.gbuffer,
              target.view,
              target.tile,
              {0, 0, target.tile.width, target.tile.height},
              projectField(*field_, coreShares_, target.view, target.origin, target.tile, target.sampleShift,
                           BallOrder::depth),
              kernelFlags(field_->kernel),
              {}};
  if (frame.projected.balls.empty()) return;
  if (!clipping_) frame.flags.insert("PLAIN");
  frame.left.assign(frame.projected.balls.size(), false);

  const std::uint64_t ballBytes = frame.projected.balls.size() * sizeof(ProjectedBall);
  balls_.reserve(ballBytes);
  balls_.write(frame.projected.balls.data(), ballBytes);
  ballTexture_.upload(frame.projected.balls.data(), frame.projected.balls.size());
  fieldUniforms_.update(&frame.projected.block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, fieldUniforms_.object.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, bezierUniforms_.object.name());
  balls_.bindStorage(0);
  statistics_.counts.bindStorage(5);

  const std::int64_t mostPixels = kListBytes / (4 * (std::int64_t{list_} + kHeaderSlots));
  for (const ScreenRect& rect : splitRect(frame.screen, mostPixels)) drawRegion(frame, rect);
  statistics_.ballsInView += static_cast<double>(frame.projected.balls.size());
  statistics_.ballsLeft += static_cast<double>(std::count(frame.left.begin(), frame.left.end(), true));
  context.bindTarget();
}

// The region's surface into the G-buffer.
void Bezier::drawRegion(Frame& frame, const ScreenRect& rect) {
  Region region;
  region.rect = rect;
  region.step = std::exp2(std::ceil(std::log2(frame.projected.reach / kSteps)));
  region.cells = makeCells(frame.projected, frame.screen, rect, tiles_, region.instances);
  if (region.cells.empty()) return;
  TexturePool& pool = frame.context.pool();
  const auto lease = [&](const char* name, gl::TextureFormat format) {
    return pool.lease(name, {format, rect.width, rect.height});
  };
  RegionTargets& t = region.targets;
  t.events = lease("surface: events", gl::TextureFormat::depth32f);
  t.eventKeys = lease("surface: balls of events", gl::TextureFormat::r32ui);
  t.lastSteps = lease("surface: last events", gl::TextureFormat::r32ui);
  t.lastKeys = lease("surface: balls of last events", gl::TextureFormat::r32ui);
  t.peel = pool.framebuffer({t.eventKeys.get()}, t.events.get());
  t.coresOnly = pool.framebuffer({}, t.events.get());
  t.step = pool.framebuffer({t.lastSteps.get(), t.lastKeys.get()}, nullptr);

  lists_.reserve(static_cast<std::uint64_t>(rect.pixels()) * 4 *
                 static_cast<std::uint64_t>(list_ + kHeaderSlots));
  lists_.bindStorage(1);
  // The list and four textures.
  statistics_.mostBytesPerPixel = std::max(statistics_.mostBytesPerPixel, 4.0 * (list_ + kHeaderSlots + 4));
  control_.reserve(sizeof(PeelControl) + sizeof(CellState) * region.cells.size());
  control_.zero();
  control_.bindStorage(2);
  setUniforms(region);
  uploadInstances(region);
  glViewport(0, 0, rect.width, rect.height);
  glEnable(GL_SCISSOR_TEST);
  if (culling_) cull(frame, region);
  for (const PeelInstance& instance : region.instances) frame.left[instance.ball] = true;
  PeelControl exhausted = 0;
  if (!region.cells.empty()) {
    peel(frame, region);
    walk(frame, region);
    control_.read(&exhausted, sizeof exhausted);
    shade(frame, region);
  }
  glDisable(GL_SCISSOR_TEST);
  checkLoops("bezier", exhausted);
}

void Bezier::setUniforms(const Region& region) {
  BezierBlock block;
  block.steps = {static_cast<float>(region.step), static_cast<float>(1 / region.step),
                 static_cast<float>(tolerance_), 0.0f};
  block.region = {region.rect.x, region.rect.y, region.rect.width, region.rect.height};
  block.list = {list_, repair_ ? kMostLayers : 0, 2, 0};
  bezierUniforms_.update(&block);
}

void Bezier::uploadInstances(const Region& region) {
  const std::uint64_t bytes = region.instances.size() * sizeof(PeelInstance);
  instances_.reserve(bytes);
  instances_.write(region.instances.data(), bytes);
  glVertexArrayVertexBuffer(vertexArray_.name(), 0, instances_.name(), 0, sizeof(PeelInstance));
}

void Bezier::scissorTo(const PeelCell& cell, const ScreenRect& corner) const {
  glScissor(corner.x + cell.rect.x, corner.y + cell.rect.y, cell.rect.width, cell.rect.height);
}

void Bezier::drawCells(const Region& region, const std::vector<PeelCell>& cells) const {
  glBindVertexArray(vertexArray_.name());
  glUniform2f(0, static_cast<float>(region.rect.width), static_cast<float>(region.rect.height));
  for (const PeelCell& cell : cells) {
    scissorTo(cell, {});
    glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, cell.count, static_cast<GLuint>(cell.first));
  }
}

// Leaves out, cell by cell, the balls that lie behind kernel spheres (§5.2) or behind what is drawn already.
// Where a ray may begin inside a ball nothing can be said: it looks for its exit, which no core hides.
void Bezier::cull(Frame& frame, Region& region) {
  const float farthest = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, region.targets.coresOnly);
  glScissor(0, 0, region.rect.width, region.rect.height);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  std::vector<PeelCell> outside = region.cells;
  std::erase_if(outside, [](const PeelCell& cell) { return cell.crossesNear; });
  glUseProgram(frame.shaders.program("surface/bezier_peel.vert", "surface/bezier_peel.frag", {"CORES"}));
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  drawCells(region, outside);
  glDisable(GL_DEPTH_TEST);

  seen_.reserve(region.instances.size() * 4);
  seen_.zero();
  seen_.bindStorage(3);
  glBindFramebuffer(GL_FRAMEBUFFER, region.targets.step);  // nothing is written to it
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glBindTextureUnit(0, region.targets.events->object.name());
  glBindTextureUnit(1, frame.context.texture(frame.gbuffer.depth).object.name());
  glUseProgram(frame.shaders.program("surface/bezier_peel.vert", "surface/bezier_peel.frag", {"VISIBLE"}));
  drawCells(region, region.cells);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<std::uint32_t> seen(region.instances.size());
  seen_.read(seen.data(), seen.size() * 4);
  keepSeen(region.cells, region.instances, seen);
  uploadInstances(region);
}

// Layers, until no cell has a pixel that is not finished.
void Bezier::peel(Frame& frame, Region& region) {
  const GLuint zero[4] = {0, 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER, region.targets.step);
  glScissor(0, 0, region.rect.width, region.rect.height);
  glClearBufferuiv(GL_COLOR, 0, zero);
  glClearBufferuiv(GL_COLOR, 1, zero);
  const std::size_t cells = region.cells.size();
  region.active.resize(cells);
  std::iota(region.active.begin(), region.active.end(), std::size_t{0});
  region.windows.resize(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    region.windows[i] = {0, std::min(kFirstWindow, region.cells[i].count), region.cells[i].rect};
    region.stretches.push_back(stretchRange(frame.view, frame.tile, region.rect, region.cells[i].rect));
  }
  // Blocks are read back layer by layer; at first all count as marked with layer 0.
  region.blocks.assign(static_cast<std::size_t>(blocksAlong(region.rect.width)) *
                           static_cast<std::size_t>(blocksAlong(region.rect.height)),
                       0);
  blocks_.reserve(region.blocks.size() * 4);
  blocks_.write(region.blocks.data(), region.blocks.size() * 4);
  blocks_.bindStorage(6);
  region.states.assign(cells, {});
  for (region.layer = 1; !region.active.empty(); ++region.layer) {
    region.measured = region.layer % kLeastPeriod == 0;
    if (region.measured) {
      for (CellState& state : region.states) state.least = 0xFFFFFFFFu;
      control_.write(region.states.data(), cells * sizeof(CellState), sizeof(PeelControl));
    }
    listUnfinished(frame, region);
    peelLayer(frame, region);
    step(frame, region);
    readStates(region);
    ++statistics_.layers;
    moveWindows(frame, region);
  }
}

// After a layer: cells that are finished are no longer active.
void Bezier::readStates(Region& region) {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  control_.read(region.states.data(), region.states.size() * sizeof(CellState), sizeof(PeelControl));
  blocks_.read(region.blocks.data(), region.blocks.size() * 4);
  statistics_.cellLayers += static_cast<double>(region.active.size());
  const auto layer = static_cast<std::uint32_t>(region.layer);
  std::erase_if(region.active, [&](std::size_t i) { return region.states[i].unfinished != layer; });
}

// What has to be looked at in the next layer.
void Bezier::listUnfinished(const Frame& frame, Region& region) {
  region.steps.clear();
  for (const std::size_t i : region.active) {
    const PeelCell& cell = region.cells[i];
    PeelWindow& window = region.windows[i];
    double bound = kMostStep;
    if (window.to < cell.count) {
      const PeelInstance& next = region.instances[static_cast<std::size_t>(cell.first + window.to)];
      bound = stepAtLeast(frame.projected.depths[next.ball].x, region.stretches[i], region.step);
    }
    const StepInstance model{{}, static_cast<std::int32_t>(i), static_cast<std::int32_t>(bound)};
    addUnfinished(cell, region.rect, region.blocks, static_cast<std::uint32_t>(region.layer) - 1, model,
                  region.steps, window.reach);
  }
}

// The windows follow their pixels.
void Bezier::moveWindows(const Frame& frame, Region& region) {
  for (const std::size_t i : region.active) {
    PeelWindow& window = region.windows[i];
    if (region.measured) window.from = firstNotPassed(frame, region, i, region.states[i].least);
    if (region.states[i].waiting != static_cast<std::uint32_t>(region.layer)) continue;
    const int more = std::max(kFirstWindow, 2 * (window.to - window.from));
    window.to = std::min(region.cells[i].count, window.from + more);
  }
}

// The first ball of a cell's window of which it is not sure that all pixels have left it.
int Bezier::firstNotPassed(const Frame& frame, const Region& region, std::size_t cell,
                           std::uint32_t least) const {
  int at = region.windows[cell].from;
  for (; at < region.windows[cell].to; ++at) {
    const PeelInstance& instance = region.instances[static_cast<std::size_t>(region.cells[cell].first + at)];
    const double depth = frame.projected.depths[instance.ball].y;
    if (!(stepAtMost(depth, region.stretches[cell], region.step) < static_cast<double>(least))) break;
  }
  return at;
}

void Bezier::peelLayer(Frame& frame, const Region& region) {
  const float farthest = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, region.targets.peel);
  glScissor(0, 0, region.rect.width, region.rect.height);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glBindTextureUnit(0, region.targets.lastSteps->object.name());
  glBindTextureUnit(1, region.targets.lastKeys->object.name());
  glUseProgram(frame.shaders.program("surface/bezier_peel.vert", "surface/bezier_peel.frag", {}));
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  std::vector<PeelCell> cells;
  for (const std::size_t i : region.active) {
    const PeelWindow& window = region.windows[i];
    cells.push_back({window.reach, region.cells[i].first + window.from, window.to - window.from});
    statistics_.instancesDrawn += cells.back().count;
  }
  drawCells(region, cells);
  glDisable(GL_DEPTH_TEST);
}

// Each texel of the last events is read and written by one and the same fragment, which OpenGL 4.5 allows
// (§9.3.1); glTextureBarrier() comes between layers.
void Bezier::step(Frame& frame, const Region& region) {
  glBindFramebuffer(GL_FRAMEBUFFER, region.targets.step);
  glTextureBarrier();
  glBindTextureUnit(2, region.targets.events->object.name());
  glBindTextureUnit(3, region.targets.eventKeys->object.name());
  glBindTextureUnit(4, frame.context.texture(frame.gbuffer.depth).object.name());
  ballTexture_.bind(5);
  drawSteps(region,
            frame.shaders.program("surface/bezier_step.vert", "surface/bezier_step.frag", frame.flags));
}

void Bezier::drawSteps(const Region& region, unsigned program) {
  const std::uint64_t bytes = region.steps.size() * sizeof(StepInstance);
  steps_.reserve(bytes);
  steps_.write(region.steps.data(), bytes);
  glVertexArrayVertexBuffer(stepArray_.name(), 0, steps_.name(), 0, sizeof(StepInstance));
  glBindVertexArray(stepArray_.name());
  glUseProgram(program);
  glUniform2f(0, static_cast<float>(region.rect.width), static_cast<float>(region.rect.height));
  glUniform2i(1, region.layer, region.measured ? 1 : 0);
  glScissor(0, 0, region.rect.width, region.rect.height);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(region.steps.size()));
}

// Pixels whose list was too short go on without one, in as many draws as it takes.
void Bezier::walk(Frame& frame, Region& region) {
  for (std::size_t i = 0; i < region.cells.size(); ++i)
    if (region.states[i].walks != 0) region.active.push_back(i);
  if (region.active.empty()) return;
  uploadCellBalls(frame, region);
  region.measured = false;
  std::fill(region.blocks.begin(), region.blocks.end(), static_cast<std::uint32_t>(region.layer) - 1);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);  // all is written to buffers
  const unsigned program =
      frame.shaders.program("surface/bezier_step.vert", "surface/bezier_walk.frag", frame.flags);
  for (; !region.active.empty(); ++region.layer) {
    region.steps.clear();
    for (const std::size_t i : region.active) {
      const StepInstance model{{}, static_cast<std::int32_t>(i), region.walkFrom[i]};
      addUnfinished(region.cells[i], region.rect, region.blocks, static_cast<std::uint32_t>(region.layer) - 1,
                    model, region.steps, region.windows[i].reach);
    }
    drawSteps(region, program);
    readStates(region);
    ++statistics_.walks;
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// The balls of the cells that are active, each cell's with one behind all others at their end.
void Bezier::uploadCellBalls(const Frame& frame, Region& region) {
  std::vector<CellBall> balls;
  region.walkFrom.assign(region.cells.size(), 0);
  for (const std::size_t i : region.active) {
    region.walkFrom[i] = static_cast<std::int32_t>(balls.size());
    const PeelCell& cell = region.cells[i];
    for (int at = cell.first; at < cell.first + cell.count; ++at) {
      const std::uint32_t ball = region.instances[static_cast<std::size_t>(at)].ball;
      const double begins = stepAtLeast(frame.projected.depths[ball].x, region.stretches[i], region.step);
      balls.push_back({ball, static_cast<std::uint32_t>(begins)});
    }
    balls.push_back({0, kBehindAll});
  }
  cellBalls_.reserve(balls.size() * sizeof(CellBall));
  cellBalls_.write(balls.data(), balls.size() * sizeof(CellBall));
  cellBalls_.bindStorage(3);
}

void Bezier::shade(Frame& frame, const Region& region) {
  frame.context.bindTarget();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  for (const bool walked : {false, true}) {
    ShaderFlags flags = channelFlags(frame.context, frame.gbuffer);
    if (walked) flags.insert("WALKED");
    unsigned program = 0;
    for (std::size_t i = 0; i < region.cells.size(); ++i) {
      if ((region.states[i].walks != 0) != walked) continue;
      if (program == 0)
        program = frame.shaders.program("surface/near_plane.vert", "surface/bezier_surface.frag", flags);
      glUseProgram(program);
      scissorTo(region.cells[i], region.rect);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  }
  glDisable(GL_DEPTH_TEST);
}

std::uint64_t Bezier::bytesOfBalls() const {
  return balls_.bytes() + ballTexture_.bytes();
}

std::vector<ResourceStats> Bezier::buffers() const {
  std::vector<ResourceStats> out;
  const auto add = [&](const char* name, std::uint64_t bytes) {
    if (bytes > 0) out.push_back({name, bytes});
  };
  add("surface: balls", bytesOfBalls());
  add("surface: instances", instances_.bytes());
  add("surface: lists", lists_.bytes());
  add("surface: balls of cells", cellBalls_.bytes());
  add("surface: control", control_.bytes() + seen_.bytes() + statistics_.counts.bytes());
  return out;
}

}  // namespace

}  // namespace meniscus

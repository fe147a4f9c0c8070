#include "render/surface/lists.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "render/gl/storage.h"
#include "render/post/fullscreen.h"
#include "render/surface/ball_texture.h"
#include "render/surface/lists_statistics.h"
#include "render/surface/peel_regions.h"
#include "render/surface/projected_field.h"

namespace meniscus {

namespace {

constexpr int kArray = 64;  // kRing of shaders/surface/lists_cast.frag

constexpr SurfaceParameter kListsParameters[] = {
    {"tolerance", "width to which a root is narrowed down, as a share of the smallest support around it",
     1e-5, 1e-7, 0.1, false},
    {"exact", "1: the balls' own polynomials; 0: the paper's cubics", 1, 0, 1, true},
    {"array", "separators that a pixel's array holds; where it is too short, the list is walked", kArray, 3,
     kArray, true},
    {"memory", "MiB that lists may take; longer ones are made band by band", 128, 0.01, 4096, false},
    {"culling", "1: balls behind the cores of others are left out (only if no coefficient is negative)", 1, 0,
     1, true},
    {"order", "1: balls are gathered back to front; 0: front to back, and each pixel turns its list round", 1,
     0, 1, true},
};

// A region's textures and heads take 20 bytes a pixel.
constexpr std::int64_t kRegionPixels = std::int64_t{1} << 22;
constexpr std::int64_t kBytesPerPixel = 20;
constexpr std::int64_t kNodeBytes = 8;
// Beyond so many supports from a pixel's first ball the ends of a chord are off by 2e-5 of the support.
constexpr float kTrustedSupports = 256;
// A ball alone whose maximum is so near the level (as a share of it) is met as a sphere, which only
// shaders/surface/lists_walk.frag does.
constexpr double kNearMaximum = 1e-3;

// ListsUniforms of shaders/include/lists.glsl.
struct ListsBlock {
  glm::vec4 settings;
  glm::ivec4 region, lists;
};

// Control of shaders/include/lists_trace.glsl.
struct ListsControl {
  std::uint32_t unanswered, exhausted;
};

// Three texels of tOrder of shaders/include/lists.glsl.
struct BallOrderTexels {
  glm::vec4 box, coreBox, distance;
};

class Lists : public SurfaceMethod {
 public:
  explicit Lists(const SurfaceParameters& values)
      : tolerance_(static_cast<float>(values.at("tolerance"))),
        array_(static_cast<int>(values.at("array"))),
        memory_(static_cast<std::int64_t>(values.at("memory") * (1 << 20))),
        exact_(values.at("exact") != 0),
        culling_(values.at("culling") != 0),
        backToFront_(values.at("order") != 0) {}

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
    SurfaceLayerRefs layers, layersBefore;
    std::string prefix;
    ProjectedField projected;
    std::vector<std::pair<int, int>> atNear;  // runs of balls in which a ray may begin: first, count
    ShaderFlags flags;
    float scale;  // from a place to a depth
    int balls() const { return static_cast<int>(projected.balls.size()); }
    bool translucent() const { return layers.valid(); }
  };
  struct Region {
    ScreenRect rect;
    TextureLease cores, counts, places;
  };

  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);
  void sort(Frame& frame, const SurfaceTarget& target);
  void drawRegion(Frame& frame, const ScreenRect& rect);
  void setUniforms(const Frame& frame, const ScreenRect& region, std::int64_t nodes, bool goOn = false);
  void layCores(Frame& frame, const Region& region);
  std::vector<float> countNodes(Frame& frame, const Region& region);
  std::vector<std::pair<ScreenRect, std::int64_t>> bandsOf(const ScreenRect& region,
                                                           const std::vector<float>& counts) const;
  void gather(Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes);
  void cast(Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes);
  void walk(Frame& frame, const Region& region);
  void shade(Frame& frame, const Region& region, const ScreenRect& band);
  void drawBalls(unsigned program, int first, int step, int count) const;

  float tolerance_;
  int array_;
  std::int64_t memory_;
  bool exact_, culling_, backToFront_;
  bool walkAll_ = false;
  const MetaballField* field_ = nullptr;
  std::vector<float> coreShares_;
  gl::Object vertexArray_;
  gl::Storage balls_, nodes_, heads_, gathered_, control_, states_;
  BallTexture ballTexture_{sizeof(ProjectedBall) / 16}, orderTexture_{sizeof(BallOrderTexels) / 16};
  gl::Buffer fieldUniforms_, listsUniforms_;
  ListsStatistics statistics_;
};

}  // namespace

std::span<const SurfaceParameter> listsParameters() {
  return kListsParameters;
}

std::unique_ptr<SurfaceMethod> makeLists(const SurfaceParameters& values) {
  return std::make_unique<Lists>(values);
}

namespace {

void Lists::prepare(const MetaballField& field) {
  field_ = &field;
  coreShares_ = coreShares(field);
  walkAll_ =
      exact_ && std::any_of(field.balls.begin(), field.balls.end(), [&](const Metaball& ball) {
        return std::abs(static_cast<double>(ball.coefficient) - field.level) < kNearMaximum * field.level;
      });
  culling_ = culling_ && field.allPositive();
  GLuint name = 0;
  glCreateVertexArrays(1, &name);  // without attributes
  vertexArray_ = gl::Object(gl::ObjectKind::vertexArray, name);
  fieldUniforms_ = gl::Buffer::updatable(sizeof(FieldBlock));
  listsUniforms_ = gl::Buffer::updatable(sizeof(ListsBlock));
  gathered_.reserve(4);
  control_.reserve(sizeof(ListsControl));
  statistics_.counts.prepare();
}

void Lists::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  std::vector<TextureRef> reads{target.gbuffer.depth};
  std::vector<FrameGraph::Attachment> writes;
  if (target.layers.valid()) {
    for (int i = 0; i < static_cast<int>(target.layers.of.size()); ++i)
      writes.push_back({target.layers.of[static_cast<std::size_t>(i)], i});
    if (target.layersBefore.valid())
      reads.insert(reads.end(), target.layersBefore.of.begin(), target.layersBefore.of.end());
  } else {
    writes = attachmentsOf(target.gbuffer);
  }
  graph.addPass(target.prefix + "surface", std::move(reads), std::move(writes),
                [this, &shaders, target](const PassContext& context) { draw(context, shaders, target); });
}

void Lists::draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target) {
  Frame frame{context, shaders, target.gbuffer, target.layers, target.layersBefore, target.prefix, {}, {},
              {},      1};
  context.part(frame.prefix + "surface: sort", [&] { sort(frame, target); });
  if (frame.balls() == 0 && !frame.translucent()) return;
  for (const ScreenRect& rect : splitRect({0, 0, target.tile.width, target.tile.height}, kRegionPixels))
    drawRegion(frame, rect);
  context.bindTarget();
}

// Puts the balls in order and uploads them.
void Lists::sort(Frame& frame, const SurfaceTarget& target) {
  frame.projected = projectField(*field_, coreShares_, target.view, target.origin, target.tile,
                                 target.sampleShift, BallOrder::distance);
  const ProjectedField& p = frame.projected;
  frame.flags = exact_ ? kernelFlags(field_->kernel) : ShaderFlags{"CUBIC"};
  if (frame.translucent()) frame.flags.insert("LAYERS");
  frame.scale = static_cast<float>(0.45 / std::max(p.reach, 1e-30));

  const bool perspective = target.view.projection == Projection::perspective;
  const double eyeAbove = perspective ? std::max(static_cast<double>(p.block.plane.y), 0.0) : 0.0;
  std::vector<BallOrderTexels> order(p.balls.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double stretch = largestStretch(target.view, target.tile, p.boxes[i]);
    const double place = p.distances[i] - eyeAbove * (stretch - 1);
    const double depth = 0.5 + place * static_cast<double>(frame.scale) - 4e-6;
    order[i] = {p.boxes[i],
                p.coreBoxes[i],
                {std::nextafter(static_cast<float>(p.distances[i]), -std::numeric_limits<float>::infinity()),
                 static_cast<float>(std::clamp(depth, 0.0, 1.0)), 0, 0}};
  }
  for (int i = 0; i < frame.balls(); ++i) {
    if (!(p.depths[static_cast<std::size_t>(i)].x < p.nearDepth)) continue;
    if (!frame.atNear.empty() && frame.atNear.back().first + frame.atNear.back().second == i) {
      ++frame.atNear.back().second;
    } else {
      frame.atNear.emplace_back(i, 1);
    }
  }
  const std::uint64_t bytes = p.balls.size() * sizeof(ProjectedBall);
  balls_.reserve(bytes);
  balls_.write(p.balls.data(), bytes);
  ballTexture_.upload(p.balls.data(), p.balls.size());
  orderTexture_.upload(order.data(), order.size());
  fieldUniforms_.update(&p.block);
  statistics_.ballsInView += frame.balls();
}

void Lists::drawRegion(Frame& frame, const ScreenRect& rect) {
  TexturePool& pool = frame.context.pool();
  const auto lease = [&](const char* name, gl::TextureFormat format) {
    return pool.lease(name, {format, rect.width, rect.height});
  };
  Region region{rect, lease("surface: cores", gl::TextureFormat::depth32f),
                lease("surface: list lengths", gl::TextureFormat::r32f),
                TextureLease(nullptr, ReturnToPool{})};
  if (!frame.translucent()) region.places = lease("surface: places", gl::TextureFormat::rg32f);
  heads_.reserve(static_cast<std::uint64_t>(rect.pixels()) * 4);
  heads_.zero();
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, fieldUniforms_.object.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, listsUniforms_.object.name());
  balls_.bindStorage(0);
  heads_.bindStorage(2);
  gathered_.bindStorage(3);
  control_.bindStorage(4);
  statistics_.counts.bindStorage(5);
  ballTexture_.bind(5);
  orderTexture_.bind(6);
  setUniforms(frame, rect, 0);
  std::vector<float> counts;
  frame.context.part(frame.prefix + "surface: depth", [&] { layCores(frame, region); });
  frame.context.part(frame.prefix + "surface: gather", [&] { counts = countNodes(frame, region); });

  std::int64_t mostNodes = 0;
  for (const auto& [band, nodes] : bandsOf(rect, counts)) {
    frame.context.part(frame.prefix + "surface: gather", [&] { gather(frame, region, band, nodes); });
    frame.context.part(frame.prefix + "surface: cast", [&] {
      cast(frame, region, band, nodes);
      if (!frame.translucent()) shade(frame, region, band);
    });
    mostNodes = std::max(mostNodes, nodes);
    ++statistics_.bands;
    statistics_.nodes += static_cast<double>(nodes);
  }
  if (!counts.empty())
    statistics_.mostOfPixel = std::max(statistics_.mostOfPixel,
                                       static_cast<double>(*std::max_element(counts.begin(), counts.end())));
  statistics_.mostBytesPerPixel =
      std::max(statistics_.mostBytesPerPixel,
               static_cast<double>(kBytesPerPixel) +
                   static_cast<double>(kNodeBytes * mostNodes) / static_cast<double>(rect.pixels()));
}

void Lists::setUniforms(const Frame& frame, const ScreenRect& region, std::int64_t nodes, bool goOn) {
  ListsBlock block;
  block.settings = {frame.scale, tolerance_, walkAll_ ? -1.0f : kTrustedSupports, 0.0f};
  block.region = {region.x, region.y, region.width, region.height};
  block.lists = {array_, static_cast<int>(nodes), goOn || frame.layersBefore.valid() ? 1 : 0, 2};
  listsUniforms_.update(&block);
}

void Lists::drawBalls(unsigned program, int first, int step, int count) const {
  if (count == 0) return;
  glUseProgram(program);
  glBindVertexArray(vertexArray_.name());
  glUniform2i(0, first, step);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

// What hides the rest: cores, unless a ray begins in a ball, and what is drawn already.
void Lists::layCores(Frame& frame, const Region& region) {
  const float farthest = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, frame.context.pool().framebuffer({}, region.cores.get()));
  glViewport(0, 0, region.rect.width, region.rect.height);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  const auto program = [&](const ShaderFlags& flags) {
    return frame.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", flags);
  };
  if (culling_ && !frame.translucent()) {
    glDepthFunc(GL_LESS);
    drawBalls(exact_ ? program({"CORES"}) : program({"CORES", "CUBIC"}), 0, 1, frame.balls());
    glDepthFunc(GL_ALWAYS);
    for (const auto& [first, count] : frame.atNear) drawBalls(program({"INSIDE"}), first, 1, count);
  }
  glDepthFunc(GL_LESS);
  glBindTextureUnit(0, frame.context.texture(frame.gbuffer.depth).object.name());
  drawFullscreen(frame.shaders.program("post/fullscreen.vert", "surface/lists_hidden.frag", {}));
  glDisable(GL_DEPTH_TEST);
}

// How many nodes each pixel's list will have: fragments are added up by blending.
std::vector<float> Lists::countNodes(Frame& frame, const Region& region) {
  const float zero[4] = {0, 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER,
                    frame.context.pool().framebuffer({region.counts.get()}, region.cores.get()));
  glClearBufferfv(GL_COLOR, 0, zero);
  glTextureBarrier();
  nodes_.reserve(kNodeBytes);
  nodes_.bindStorage(1);
  glBindTextureUnit(0, region.cores->object.name());
  const unsigned program = frame.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", {});
  glUseProgram(program);
  glUniform1i(1, 0);
  // The cores are read and tested against, but not written: OpenGL 4.5, 9.3.1.
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  drawBalls(program, 0, 1, frame.balls());
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  std::vector<float> counts(static_cast<std::size_t>(region.rect.pixels()));
  region.counts->read(region.rect.width, region.rect.height, region.rect.width, counts.data());
  return counts;
}

// Parts of a region whose lists fit into memory, and how many nodes they have.
std::vector<std::pair<ScreenRect, std::int64_t>> Lists::bandsOf(const ScreenRect& region,
                                                                const std::vector<float>& counts) const {
  const std::int64_t bytes = std::min(memory_, gl::queryLimits().storageBlock), most = bytes / kNodeBytes;
  std::vector<std::pair<ScreenRect, std::int64_t>> bands;
  const auto width = static_cast<std::size_t>(region.width);
  const auto sumOf = [&](std::size_t first, std::size_t count) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += static_cast<std::int64_t>(counts[first + i]);
    return sum;
  };
  for (int y = 0; y < region.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width;
    const std::int64_t nodes = sumOf(row, width);
    if (nodes > most) {  // a part of a row by itself
      for (int x = 0; x < region.width; ++x) {
        const std::int64_t here = sumOf(row + static_cast<std::size_t>(x), 1);
        if (here > most)
          throw InputError(
              fmt::format("surface method lists: {} balls lie behind one pixel, whose list takes more than "
                          "the {:.4g} MiB that "
                          "this driver or --surface-option memory=N allow; use --surface-method tiles",
                          here, static_cast<double>(bytes) / (1 << 20)));
        if (x > 0 && bands.back().second + here <= most) {
          ++bands.back().first.width;
          bands.back().second += here;
        } else {
          bands.push_back({{x, y, 1, 1}, here});
        }
      }
    } else if (!bands.empty() && bands.back().first.width == region.width &&
               bands.back().second + nodes <= most) {
      ++bands.back().first.height;
      bands.back().second += nodes;
    } else {
      bands.push_back({{0, y, region.width, 1}, nodes});
    }
  }
  return bands;
}

void Lists::gather(Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes) {
  if (nodes == 0) return;
  nodes_.reserve(static_cast<std::uint64_t>(nodes * kNodeBytes));
  nodes_.bindStorage(1);
  gathered_.zero();
  setUniforms(frame, region.rect, nodes);
  glBindFramebuffer(GL_FRAMEBUFFER,
                    frame.context.pool().framebuffer({region.counts.get()}, region.cores.get()));
  glViewport(0, 0, region.rect.width, region.rect.height);
  glEnable(GL_SCISSOR_TEST);
  glScissor(band.x, band.y, band.width, band.height);
  glBindTextureUnit(0, region.cores->object.name());
  const unsigned program = frame.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", {});
  glUseProgram(program);
  glUniform1i(1, 1);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawBalls(program, backToFront_ ? frame.balls() - 1 : 0, backToFront_ ? -1 : 1, frame.balls());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  std::uint32_t gathered = 0;
  gathered_.read(&gathered, sizeof gathered);
  if (gathered != nodes)
    throw GraphicsError(fmt::format(
        "surface method lists: the driver gathered {} nodes where it had counted {}; please report "
        "it with the output of 'meniscus doctor'",
        gathered, nodes));
}

void Lists::cast(Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes) {
  ScreenRect part = band;
  if (frame.translucent()) {
    frame.context.bindTarget();
    part.x += region.rect.x;
    part.y += region.rect.y;
    glBindTextureUnit(4, frame.context.texture(frame.gbuffer.depth).object.name());
    if (frame.layersBefore.valid()) {
      for (std::size_t i = 0; i < frame.layersBefore.of.size(); ++i)
        glBindTextureUnit(7 + static_cast<GLuint>(i),
                          frame.context.texture(frame.layersBefore.of[i]).object.name());
    }
  } else {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.context.pool().framebuffer({region.places.get()}, nullptr));
    glViewport(0, 0, region.rect.width, region.rect.height);
  }
  control_.zero();
  glBindTextureUnit(0, region.cores->object.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  drawFullscreen(frame.shaders.program("post/fullscreen.vert", "surface/lists_cast.frag", frame.flags));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  ListsControl control{};
  control_.read(&control, sizeof control);
  if (control.unanswered > 0) {
    setUniforms(frame, region.rect, nodes, frame.translucent());
    walk(frame, region);
  }
  glDisable(GL_SCISSOR_TEST);
}

// Pixels that the cast could not answer, each for some pieces at a time.
void Lists::walk(Frame& frame, const Region& region) {
  states_.reserve(static_cast<std::uint64_t>(region.rect.pixels()) * 16);
  states_.zero();
  states_.bindStorage(6);
  if (frame.translucent()) {  // each texel is read and written by the same fragment: OpenGL 4.5, 9.3.1
    for (std::size_t i = 0; i < frame.layers.of.size(); ++i)
      glBindTextureUnit(7 + static_cast<GLuint>(i), frame.context.texture(frame.layers.of[i]).object.name());
  }
  const unsigned program =
      frame.shaders.program("post/fullscreen.vert", "surface/lists_walk.frag", frame.flags);
  ListsControl control{1, 0};
  while (control.unanswered > 0) {
    control_.zero();
    glTextureBarrier();
    drawFullscreen(program);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    control_.read(&control, sizeof control);
    if (control.exhausted > 0)
      throw InputError(fmt::format(
          "surface method lists: more balls overlap in {} pixels than the driver's loops can go through; use "
          "--surface-method tiles",
          control.exhausted));
  }
}

void Lists::shade(Frame& frame, const Region& region, const ScreenRect& band) {
  frame.context.bindTarget();
  const ShaderFlags flags = channelFlags(frame.context, frame.gbuffer);
  glBindTextureUnit(0, region.places->object.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glEnable(GL_SCISSOR_TEST);
  glScissor(region.rect.x + band.x, region.rect.y + band.y, band.width, band.height);
  drawFullscreen(frame.shaders.program("surface/near_plane.vert", "surface/lists_surface.frag", flags));
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
}

std::uint64_t Lists::bytesOfBalls() const {
  return balls_.bytes() + ballTexture_.bytes() + orderTexture_.bytes();
}

std::vector<ResourceStats> Lists::buffers() const {
  std::vector<ResourceStats> out;
  const auto add = [&](const char* name, std::uint64_t bytes) {
    if (bytes > 0) out.push_back({name, bytes});
  };
  add("surface: balls", bytesOfBalls());
  add("surface: nodes of lists", nodes_.bytes());
  add("surface: heads of lists", heads_.bytes());
  add("surface: control",
      gathered_.bytes() + control_.bytes() + states_.bytes() + statistics_.counts.bytes());
  return out;
}

}  // namespace

}  // namespace meniscus

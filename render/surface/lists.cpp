#include "render/surface/lists.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>

#include "core/error.h"
#include "render/gl/storage.h"
#include "render/surface/list_caster.h"
#include "render/surface/projected_field.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kListsParameters[] = {
    {"tolerance", "width to which a root is narrowed down, as a share of the smallest support around it",
     1e-5, 1e-7, 0.1, false},
    {"exact", "1: the balls' own polynomials; 0: the paper's cubics", 1, 0, 1, true},
    {"array", "separators that a pixel's array holds; where it is too short, the list is walked", kListArray,
     3, kListArray, true},
    {"memory", "MiB that lists may take; longer ones are made band by band", 128, 0.01, 4096, false},
    {"culling", "1: balls behind the cores of others are left out (only if no coefficient is negative)", 1, 0,
     1, true},
    {"order", "1: balls are gathered back to front; 0: front to back, and each pixel turns its list round", 1,
     0, 1, true},
};

constexpr std::int64_t kNodeBytes = 8;

class Lists : public SurfaceMethod {
 public:
  explicit Lists(const SurfaceParameters& values)
      : memory_(static_cast<std::int64_t>(values.at("memory") * (1 << 20))),
        exact_(values.at("exact") != 0),
        culling_(values.at("culling") != 0),
        backToFront_(values.at("order") != 0),
        caster_("lists", values.at("tolerance"), static_cast<int>(values.at("array")), exact_) {}

  void prepare(const MetaballField& field) override;
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override { return caster_.statistics().take("lists"); }
  std::vector<ResourceStats> buffers() const override;
  std::uint64_t bytesOfBalls() const override { return balls_.bytes(); }

 private:
  // What is the same for all regions of a target.
  struct Frame {
    ListTarget target;
    std::string prefix;
    std::vector<std::pair<int, int>> atNear;  // runs of balls in which a ray may begin: first, count
    int balls;
  };
  struct Region {
    ListRegion list;
    TextureLease counts;
  };

  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);
  void sort(Frame& frame, const SurfaceTarget& target);
  void drawRegion(Frame& frame, const ScreenRect& rect);
  void layCores(const Frame& frame, const Region& region);
  std::vector<float> countNodes(const Frame& frame, const Region& region);
  std::vector<std::pair<ScreenRect, std::int64_t>> bandsOf(const ScreenRect& region,
                                                           const std::vector<float>& counts) const;
  void gather(const Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes);
  void drawBalls(unsigned program, int first, int step, int count) const;

  std::int64_t memory_;
  bool exact_, culling_, backToFront_;
  const MetaballField* field_ = nullptr;
  std::vector<float> coreShares_;
  gl::Object vertexArray_;
  gl::Storage nodes_, gathered_;
  ListBalls balls_;
  ListCaster caster_;
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
  culling_ = culling_ && field.allPositive();
  GLuint name = 0;
  glCreateVertexArrays(1, &name);  // without attributes
  vertexArray_ = gl::Object(gl::ObjectKind::vertexArray, name);
  gathered_.reserve(4);
  caster_.prepare(field);
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
  const bool translucent = target.layers.valid();
  const ListTarget list{
      context, shaders, target.gbuffer, target.layers, target.layersBefore, caster_.flags(translucent), 1};
  Frame frame{list, target.prefix, {}, 0};
  context.part(frame.prefix + "surface: sort", [&] { sort(frame, target); });
  if (frame.balls == 0 && !translucent) return;
  for (const ScreenRect& rect : splitRect({0, 0, target.tile.width, target.tile.height}, kListRegionPixels))
    drawRegion(frame, rect);
  context.bindTarget();
}

// Puts the balls in order and uploads them.
void Lists::sort(Frame& frame, const SurfaceTarget& target) {
  const ProjectedField projected = projectField(*field_, coreShares_, target.view, target.origin, target.tile,
                                                target.sampleShift, BallOrder::distance);
  frame.balls = static_cast<int>(projected.balls.size());
  for (int i = 0; i < frame.balls; ++i) {
    if (!(projected.depths[static_cast<std::size_t>(i)].x < projected.nearDepth)) continue;
    if (!frame.atNear.empty() && frame.atNear.back().first + frame.atNear.back().second == i) {
      ++frame.atNear.back().second;
    } else {
      frame.atNear.emplace_back(i, 1);
    }
  }
  balls_.upload(projected, target.view, target.tile);
  frame.target.placeScale = balls_.placeScale();
  caster_.statistics().ballsInView += frame.balls;
}

void Lists::drawRegion(Frame& frame, const ScreenRect& rect) {
  const PassContext& context = frame.target.context;
  const Region region{
      caster_.begin(frame.target, rect),
      context.pool().lease("surface: list lengths", {gl::TextureFormat::r32f, rect.width, rect.height})};
  balls_.bind();
  gathered_.bindStorage(3);
  std::vector<float> counts;
  context.part(frame.prefix + "surface: depth", [&] { layCores(frame, region); });
  context.part(frame.prefix + "surface: gather", [&] { counts = countNodes(frame, region); });

  ListsStatistics& statistics = caster_.statistics();
  std::int64_t mostNodes = 0;
  for (const auto& [band, nodes] : bandsOf(rect, counts)) {
    context.part(frame.prefix + "surface: gather", [&] { gather(frame, region, band, nodes); });
    context.part(frame.prefix + "surface: cast",
                 [&] { caster_.draw(frame.target, region.list, band, nodes); });
    mostNodes = std::max(mostNodes, nodes);
    ++statistics.bands;
    statistics.nodes += static_cast<double>(nodes);
  }
  if (!counts.empty())
    statistics.mostOfPixel = std::max(statistics.mostOfPixel,
                                      static_cast<double>(*std::max_element(counts.begin(), counts.end())));
  statistics.mostBytesPerPixel =
      std::max(statistics.mostBytesPerPixel,
               static_cast<double>(kListBytesPerPixel) +
                   static_cast<double>(kNodeBytes * mostNodes) / static_cast<double>(rect.pixels()));
}

void Lists::drawBalls(unsigned program, int first, int step, int count) const {
  if (count == 0) return;
  glUseProgram(program);
  glBindVertexArray(vertexArray_.name());
  glUniform2i(0, first, step);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

// What hides the rest: cores, unless a ray begins in a ball, and what is drawn already.
void Lists::layCores(const Frame& frame, const Region& region) {
  caster_.clearCores(frame.target, region.list);
  glEnable(GL_DEPTH_TEST);
  const auto program = [&](const ShaderFlags& flags) {
    return frame.target.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", flags);
  };
  if (culling_ && !frame.target.translucent()) {
    glDepthFunc(GL_LESS);
    drawBalls(exact_ ? program({"CORES"}) : program({"CORES", "CUBIC"}), 0, 1, frame.balls);
    glDepthFunc(GL_ALWAYS);
    for (const auto& [first, count] : frame.atNear) drawBalls(program({"INSIDE"}), first, 1, count);
  }
  caster_.layHidden(frame.target);
}

// How many nodes each pixel's list will have: fragments are added up by blending.
std::vector<float> Lists::countNodes(const Frame& frame, const Region& region) {
  const float zero[4] = {0, 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER,
                    frame.target.context.pool().framebuffer({region.counts.get()}, region.list.cores.get()));
  glClearBufferfv(GL_COLOR, 0, zero);
  glTextureBarrier();
  nodes_.reserve(kNodeBytes);
  nodes_.bindStorage(1);
  glBindTextureUnit(0, region.list.cores->object.name());
  const unsigned program =
      frame.target.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", {});
  glUseProgram(program);
  glUniform1i(1, 0);
  // The cores are read and tested against, but not written: OpenGL 4.5, 9.3.1.
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  drawBalls(program, 0, 1, frame.balls);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  std::vector<float> counts(static_cast<std::size_t>(region.list.rect.pixels()));
  region.counts->read(region.list.rect.width, region.list.rect.height, region.list.rect.width, counts.data());
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

void Lists::gather(const Frame& frame, const Region& region, const ScreenRect& band, std::int64_t nodes) {
  if (nodes == 0) return;
  nodes_.reserve(static_cast<std::uint64_t>(nodes * kNodeBytes));
  nodes_.bindStorage(1);
  gathered_.zero();
  caster_.setUniforms(frame.target, region.list.rect, nodes);
  glBindFramebuffer(GL_FRAMEBUFFER,
                    frame.target.context.pool().framebuffer({region.counts.get()}, region.list.cores.get()));
  glViewport(0, 0, region.list.rect.width, region.list.rect.height);
  glEnable(GL_SCISSOR_TEST);
  glScissor(band.x, band.y, band.width, band.height);
  glBindTextureUnit(0, region.list.cores->object.name());
  const unsigned program =
      frame.target.shaders.program("surface/lists_balls.vert", "surface/lists_balls.frag", {});
  glUseProgram(program);
  glUniform1i(1, 1);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawBalls(program, backToFront_ ? frame.balls - 1 : 0, backToFront_ ? -1 : 1, frame.balls);
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

std::vector<ResourceStats> Lists::buffers() const {
  std::vector<ResourceStats> out;
  const auto add = [&](const char* name, std::uint64_t bytes) {
    if (bytes > 0) out.push_back({name, bytes});
  };
  add("surface: balls", bytesOfBalls());
  add("surface: nodes of lists", nodes_.bytes());
  add("surface: heads of lists", caster_.bytesOfHeads());
  add("surface: control", gathered_.bytes() + caster_.bytesOfControl());
  return out;
}

}  // namespace

}  // namespace meniscus

// Table 1 and §5 of Sigg, Weyrich, Botsch, Gross, GPU-Based Ray-Casting of Quadratic Surfaces, PBG 2006, on
// this machine: the same shading done for every fragment (direct) and once per pixel (deferred), 1024 x 768,
// without and with soft shadows, and with lines.
//
//   direct_vs_deferred [repetitions] > direct_vs_deferred.csv
//
// Both draw the same quadrics with the same vertex programs in the same order (but for tiles, as they are
// drawn without a GPU), and filter the same shadow map with the same code; times are processor times, medians
// of interleaved repetitions, with reading back. The direct program is bench/shaders/; deferred is the
// renderer. Lines need their neighbours' depths and normals, which only deferred shading has: as in the
// paper, its time with lines is compared with the direct one's without.

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <memory>

#include "bench/bench_scenes.h"
#include "core/light_view.h"
#include "render/gl/context.h"
#include "render/post/shadow.h"
#include "render/quadrics.h"
#include "render/renderer.h"
#include "render/view_block.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};
constexpr Background kNothing{0x000000, true};

struct Source {
  const char* name;
  SceneSource scene;
  double paperRatio[2];  ///< deferred / direct frames per second in the paper's Table 1, without and with
                         ///< shadows (there with lines, too)
};
const Source kSources[] = {
    {"99k spheres, 198k cylinders",
     {"7ddo.pdb.gz", Representation::ballAndStick, {4, 2, 2}, 99000, true},
     {34.0 / 37, 13 / 3.9}},
    {"52k spheres", {"7ddo.pdb.gz", Representation::spacefill, {3, 3, 1}, 52000}, {26.0 / 31, 15 / 2.6}},
    {"15k spheres", {"2hhb.pdb.gz", Representation::spacefill, {2, 2, 1}, 15000}, {51.0 / 79, 22 / 5.5}},
    {"1712 spheres", {"1a0q.pdb.gz", Representation::spacefill, {1, 1, 1}, 1712}, {67.0 / 94, 22 / 7.2}},
};

struct Kind {
  const char* name;
  ShadowSettings shadows;
  bool lines = false;  // right after the same without
};
const ShadowSettings kAll{ShadowMode::soft, 2, 64, 0},
    kAdaptive{ShadowMode::soft, 2, 64, ShadowSettings{}.probes};
const Kind kKinds[] = {{"no shadows", {}},
                       {"no shadows, lines", {}, true},
                       {"soft shadows, 64 samples", kAll},
                       {"soft shadows, 64 samples, lines", kAll, true},
                       {"soft shadows, adaptive", kAdaptive},
                       {"soft shadows, adaptive, lines", kAdaptive, true}};

// How deferred shading is drawn. Only where shading waits for what is visible can the processor shade, or
// tiles find what is visible.
struct Way {
  const char* name;
  bool onProcessor;
  QuadricMethod quadrics;
};
const Way kWays[] = {{"shaders", false, QuadricMethod::splat},
                     {"processor", true, QuadricMethod::splat},
                     {"processor with tiles", true, QuadricMethod::tiles}};
constexpr std::size_t kWayCount = std::size(kWays);

RenderSettings settingsOf(const ShadowSettings& shadows, bool lines, QuadricMethod quadrics) {
  RenderSettings settings;
  settings.samples = 1;
  settings.quadrics = quadrics;
  settings.shadows = shadows;
  settings.lines.silhouettes = settings.lines.creases = lines;
  return settings;
}

// A little more each time, so that no shadow map serves twice, which the direct program draws anew, too.
void turn(View& view) {
  view.rotation = glm::dmat3(glm::rotate(glm::dmat4(view.rotation), 1e-4, glm::dvec3(0, 1, 0)));
}

RendererOptions optionsOf(bool timePasses, bool onProcessor) {
  return {.shaderDir = {}, .timePasses = timePasses, .maxTileSize = 0, .effectsOnProcessor = onProcessor};
}

// Layout of DirectUniforms in bench/shaders/direct.glsl.
struct DirectBlock {
  glm::vec4 key, fill, ambient;
};

glm::vec4 towardsLight(const DirectionalLight& light) {
  return {glm::vec3(-glm::normalize(light.direction)), static_cast<float>(light.intensity)};
}

/// Shades every fragment.
class DirectRenderer {
 public:
  explicit DirectRenderer(const Primitives& primitives) : primitives_(primitives) {
    quadrics_.upload(primitives);
    viewUniforms_ = gl::Buffer::updatable(sizeof(f32::ViewBlock));
  }

  void draw(const View& view, const Lighting& lighting, const ShadowSettings& shadows) {
    const bool shadow = shadows.mode != ShadowMode::off;
    ShadowMap map;
    FrameGraph mapGraph(pool_);
    if (shadow) map = drawMap(mapGraph, view, lighting, shadows);

    setView(view);
    if (shadow) shadowUniforms_.set(shadows, view, map, 0, 1);
    const DirectBlock block{
        towardsLight(lighting.key), towardsLight(lighting.fill),
        glm::vec4(glm::dvec4(lighting.ambient, lighting.specular, lighting.shininess, 0))};
    const gl::Buffer uniforms = gl::Buffer::fromData(&block, sizeof(block));
    FrameGraph graph(pool_);
    const TextureRef depth =
        graph.create("depth", {gl::TextureFormat::depth32f, view.size.width, view.size.height});
    const TextureRef picture =
        graph.create("picture", {gl::TextureFormat::rgba8, view.size.width, view.size.height});
    const auto add = [&](const QuadricBuffers::Kind& kind, const std::string& shape) {
      if (kind.count == 0) return;
      graph.addPass("direct " + shape, {depth}, {{depth, FrameGraph::kDepth}, {picture, 0}},
                    [&, shape](const PassContext&) {
                      ShaderFlags flags{"ENCODE_SRGB"};
                      if (shadow) {
                        flags.insert({"SHADOW", "SOFT"});
                        glBindTextureUnit(2, map.depth->object.name());
                        glBindBufferBase(GL_UNIFORM_BUFFER, 1, shadowUniforms_.name());
                      }
                      glBindBufferBase(GL_UNIFORM_BUFFER, 2, uniforms.object.name());
                      glUseProgram(shaders_.program("quadrics/" + shape + ".vert",
                                                    "bench/direct_" + shape + ".frag", flags));
                      glBindVertexArray(kind.vertexArray.name());
                      glEnable(GL_DEPTH_TEST);
                      glDepthFunc(GL_GREATER);
                      glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, kind.count);
                      glDisable(GL_DEPTH_TEST);
                    });
    };
    add(quadrics_.spheres(), "sphere");
    add(quadrics_.cylinders(), "cylinder");
    graph.want(picture);
    graph.execute(stats_, false);
    glFinish();
    pixels_.resize(static_cast<std::size_t>(view.size.width * view.size.height) * 4);
    graph.texture(picture).read(view.size.width, view.size.height, view.size.width, pixels_.data());
  }

  const std::vector<std::uint8_t>& pixels() const { return pixels_; }  ///< rows from the bottom

 private:
  void setView(const View& view) {
    const f32::ViewBlock block =
        makeViewBlock(view, primitives_.origin, {0, 0, view.size.width, view.size.height}, {0, 0});
    viewUniforms_.update(&block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewUniforms_.object.name());
  }

  // As the renderer does.
  ShadowMap drawMap(FrameGraph& graph, const View& view, const Lighting& lighting,
                    const ShadowSettings& shadows) {
    const BoundingSphere bounds = primitives_.bounds();
    const double texel =
        shadowTexelSize(pixelFootprint(view, bounds), shadows.penumbra, primitives_.thinnestRadius());
    const View light =
        makeLightView(view, lighting.key, bounds, texel, largestShadowMap(view.size), shadows.penumbra);
    setView(light);
    GBufferRefs map;
    map.depth =
        graph.create("shadow map", {gl::TextureFormat::depth32f, light.size.width, light.size.height});
    addQuadrics(graph, quadrics_, shaders_, map);
    graph.want(map.depth);
    graph.execute(stats_, false);
    return {light, &graph.texture(map.depth)};
  }

  const Primitives& primitives_;
  ShaderLibrary shaders_{MENISCUS_BENCH_SHADERS};
  TexturePool pool_;
  QuadricBuffers quadrics_;
  gl::Buffer viewUniforms_;
  ShadowUniforms shadowUniforms_;
  RenderStats stats_;
  std::vector<std::uint8_t> pixels_;
};

/// Keeps a picture.
class ByteSink : public RowSink {
 public:
  void writeRows(std::span<const std::byte> rows) override {
    bytes.insert(bytes.end(), rows.begin(), rows.end());
  }
  std::vector<std::byte> bytes;
};

// Mean difference of the two pictures in 8-bit steps: both must show the same.
double differenceOf(const std::vector<std::byte>& fromTop, const std::vector<std::uint8_t>& fromBottom) {
  const std::size_t row = static_cast<std::size_t>(kSize.width) * 4;
  double sum = 0;
  for (std::size_t i = 0; i < fromTop.size(); ++i) {
    const std::size_t y = static_cast<std::size_t>(kSize.height) - 1 - i / row;
    sum += std::abs(std::to_integer<int>(fromTop[i]) - static_cast<int>(fromBottom[y * row + i % row]));
  }
  return sum / static_cast<double>(fromTop.size());
}

void measure(const Source& source, int repetitions) {
  const BenchScene scene = loadScene(source.scene, kSize);
  const Lighting lighting;
  DirectRenderer direct(*scene.primitives);
  std::vector<std::unique_ptr<Renderer>> deferred;
  View view = scene.view;
  for (const Way& way : kWays) {
    deferred.push_back(std::make_unique<Renderer>(optionsOf(false, way.onProcessor)));
    deferred.back()->setPrimitives(scene.primitives);
  }
  const auto draw = [&](std::size_t way, const Kind& kind, RowSink& sink) {
    deferred[way]->renderPicture(view, lighting, kNothing,
                                 settingsOf(kind.shadows, kind.lines, kWays[way].quadrics),
                                 PixelFormat::rgba8, sink);
  };
  constexpr std::size_t kCount = std::size(kKinds);
  std::vector<double> directMs[kCount], deferredMs[kCount][kWayCount];
  double difference[kCount][kWayCount] = {};
  double directTime = 0;
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up and compares
    for (std::size_t k = 0; k < kCount; ++k) {
      turn(view);
      if (!kKinds[k].lines) directTime = processorMs([&] { direct.draw(view, lighting, kKinds[k].shadows); });
      if (repetition >= 0) directMs[k].push_back(directTime);
      for (std::size_t w = 0; w < kWayCount; ++w) {
        if (repetition < 0) {
          ByteSink sink;
          draw(w, kKinds[k], sink);
          difference[k][w] = differenceOf(sink.bytes, direct.pixels());
          continue;
        }
        NullSink sink;
        deferredMs[k][w].push_back(processorMs([&] { draw(w, kKinds[k], sink); }));
      }
    }
  }
  for (std::size_t k = 0; k < kCount; ++k) {
    for (std::size_t w = 0; w < kWayCount; ++w) {
      const double a = median(directMs[k]), b = median(deferredMs[k][w]);
      fmt::print("table,\"{}\",{},{},\"{}\",{},{:.1f},{:.1f},{:.2f},{:.2f},{}\n", source.name,
                 scene.primitives->spheres.size(), scene.primitives->cylinders.size(), kKinds[k].name,
                 kWays[w].name, a, b, a / b, source.paperRatio[kKinds[k].shadows.mode != ShadowMode::off],
                 kKinds[k].lines ? std::string() : fmt::format("{:.5f}", difference[k][w]));
      std::fflush(stdout);
    }
  }

  // §5: shares of the passes. The probes alone: as many samples as there are probes.
  Renderer timed(optionsOf(true, false));
  timed.setPrimitives(scene.primitives);
  const auto passMs = [&](const ShadowSettings& shadows) {
    std::map<std::string, double> before, spent;
    for (const PassStats& pass : timed.stats().passes) before[pass.name] = pass.milliseconds;
    NullSink sink;
    turn(view);
    timed.renderPicture(view, lighting, kNothing, settingsOf(shadows, true, QuadricMethod::splat),
                        PixelFormat::rgba8, sink);
    for (const PassStats& pass : timed.stats().passes) {
      const double ms = pass.milliseconds - before[pass.name];
      if (ms <= 0) continue;
      const bool map = pass.name.starts_with("shadow map");
      spent[map                                             ? "shadow map"
            : pass.name == "shadow" || pass.name == "shade" ? pass.name
            : pass.name.starts_with("silhouette")           ? "lines"
                                                            : "quadrics"] += ms;
    }
    return spent;
  };
  const int probes = ShadowSettings{}.probes;
  std::map<std::string, std::vector<double>> parts;
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    const auto adaptive = passMs({ShadowMode::soft, 2, 64, probes});
    const auto probing = passMs({ShadowMode::soft, 2, probes, 0});
    if (repetition < 0) continue;
    for (const char* part : {"shadow map", "quadrics", "shade", "lines"})
      parts[part].push_back(adaptive.at(part));
    const double test = std::min(probing.at("shadow"), adaptive.at("shadow"));
    parts["probes"].push_back(test);
    parts["refinement"].push_back(adaptive.at("shadow") - test);
  }
  double total = 0;
  for (const auto& [part, ms] : parts) total += median(ms);
  for (const auto& [part, ms] : parts) {
    fmt::print("share,\"{}\",,,{},shaders,,{:.1f},{:.3f},,\n", source.name, part, median(ms),
               median(ms) / total);
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "what,scene,spheres,cylinders,kind,effects_by,direct_ms,deferred_ms,ratio_or_share,paper_ratio,"
        "difference\n");
    for (const bench::Source& source : bench::kSources) bench::measure(source, repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "direct_vs_deferred: %s\n", error.what());
    return 1;
  }
  return 0;
}

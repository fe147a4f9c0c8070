// Error against time of what is sampled: soft shadows against 4,096 samples, supersampling against 256 rays.
//
//   shadow_error [repetitions] > shadow_error.csv
//
// A row per scene and setting. Shadow errors are over the pixels that face the light; processor times are
// medians of interleaved repetitions: of the shadow pass alone, and of the whole frame (shadow map, G-buffer,
// shadow, shading) through the renderer.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "app/measure/shadow_run.h"
#include "bench/bench_scenes.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};

struct Source {
  const char* name;
  SceneSource scene;
  double penumbra = ShadowSettings{}.penumbra;
};
const Source kSources[] = {
    {"ubiquitin, space-filling", {"1ubq.pdb"}},
    {"hemoglobin, space-filling", {"2hhb.pdb.gz"}},
    {"hemoglobin, space-filling", {"2hhb.pdb.gz"}, 0.6},
    {"hemoglobin, licorice", {"2hhb.pdb.gz", Representation::licorice}},
    {"ACE2 x 8, space-filling", {"7ddo.pdb.gz", Representation::spacefill, {2, 2, 2}}},
};

void measureShadows(const Source& source, int repetitions) {
  const BenchScene scene = loadScene(source.scene, kSize);
  const std::vector<std::pair<int, int>> settings = {{1, 0},  {4, 0},  {8, 0},   {16, 0},
                                                     {64, 0}, {64, 8}, {64, 16}, {256, 0}};
  for (const measure::ShadowPoint& p : measure::measureShadowPoints(
           scene.primitives, scene.view, source.penumbra, settings, repetitions, {})) {
    const std::string name =
        p.probes > 0 ? fmt::format("{} to {}", p.probes, p.samples) : fmt::format("{}", p.samples);
    fmt::print("shadow,\"{}\",{},{},{},{:.5f},{:.4f},{:.2f},{:.2f},{:.1f},{:.3f}\n", source.name,
               source.penumbra, name, p.samples, p.rms, p.largest, p.passMs, p.frameMs, p.samplesTaken,
               p.penumbraShare);
    std::fflush(stdout);
  }
}

/// Keeps a picture of floats.
class FloatSink : public RowSink {
 public:
  void writeRows(std::span<const std::byte> rows) override {
    const std::size_t count = rows.size() / sizeof(float);
    values.resize(values.size() + count);
    std::memcpy(values.data() + values.size() - count, rows.data(), rows.size());
  }
  std::vector<float> values;
};

void measureSupersampling(const Source& source, int repetitions) {
  const BenchScene scene = loadScene(source.scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  const auto draw = [&](int samples) {
    RenderSettings settings;
    settings.samples = samples;
    FloatSink sink;
    renderer.renderPicture(scene.view, Lighting{}, Background{}, settings, PixelFormat::rgbaFloat, sink);
    return sink.values;
  };
  const std::vector<float> truth = draw(256);
  const std::vector<bool> all(truth.size(), true);
  const int counts[] = {1, 4, 16};
  std::vector<double> ms[std::size(counts)];
  measure::ShareError errors[std::size(counts)];
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (std::size_t s = 0; s < std::size(counts); ++s) {
      std::vector<float> picture;
      const double spent = processorMs([&] { picture = draw(counts[s]); });
      errors[s] = measure::compareShares(picture, truth, all);
      if (repetition >= 0) ms[s].push_back(spent);
    }
  }
  for (std::size_t s = 0; s < std::size(counts); ++s) {
    fmt::print("supersampling,\"{}\",,{},{},{:.5f},{:.4f},,{:.2f},,\n", source.name, counts[s], counts[s],
               errors[s].rms, errors[s].largest, median(ms[s]));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "what,scene,penumbra,setting,samples,rms,largest,pass_ms,frame_ms,samples_taken,penumbra_share\n");
    for (const bench::Source& source : bench::kSources) bench::measureShadows(source, repetitions);
    bench::measureSupersampling(bench::kSources[0], repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shadow_error: %s\n", error.what());
    return 1;
  }
  return 0;
}

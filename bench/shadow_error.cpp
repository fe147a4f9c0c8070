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

#include "bench/bench_scenes.h"
#include "render/gl/context.h"
#include "render/renderer.h"
#include "render/shadow_scene.h"

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

struct Setting {
  const char* name;
  int samples, probes;
};
const Setting kSettings[] = {{"1", 1, 0},   {"4", 4, 0},        {"8", 8, 0},          {"16", 16, 0},
                             {"64", 64, 0}, {"8 to 64", 64, 8}, {"16 to 64", 64, 16}, {"256", 256, 0}};

struct Error {
  double rms = 0, largest = 0;
};

Error compare(const std::vector<float>& values, const std::vector<float>& truth,
              const std::vector<bool>& counts) {
  Error error;
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts[i]) continue;
    const double d = static_cast<double>(values[i]) - static_cast<double>(truth[i]);
    sum += d * d;
    error.largest = std::max(error.largest, std::abs(d));
    ++n;
  }
  error.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(n, 1)));
  return error;
}

ShadowSettings shadowsOf(const Source& source, const Setting& setting) {
  return {ShadowMode::soft, source.penumbra, setting.samples, setting.probes};
}

// Samples that a pixel facing the light takes, on average.
double samplesTaken(const std::vector<float>& values, const std::vector<bool>& counts,
                    const Setting& setting) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts[i]) continue;
    const bool agreed = setting.probes > 0 && (values[i] == 0.0f || values[i] == 1.0f);
    sum += agreed ? setting.probes : setting.samples;
    n += 1;
  }
  return sum / std::max(n, 1.0);
}

void measureShadows(const Source& source, int repetitions) {
  const BenchScene scene = loadScene(source.scene, kSize);
  const Lighting lighting;
  ShadowScene shadows(*scene.primitives, scene.view, lighting.key);

  constexpr int kPatterns = 16;  // of 256 samples
  std::vector<float> truth(shadows.depth().size(), 0.0f);
  for (int k = 0; k < kPatterns; ++k) {
    const std::vector<float> part = shadows.visibility(shadowsOf(source, {"", 256, 0}), k, kPatterns);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] += part[i] / static_cast<float>(kPatterns);
  }
  const glm::dvec3 toLight = -lighting.key.direction;
  std::vector<bool> facing(truth.size());
  std::size_t lit = 0, penumbra = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    facing[i] = shadows.depth()[i] > 0 && glm::dot(glm::dvec3(shadows.normal()[i]), toLight) > 0;
    lit += facing[i];
    penumbra += facing[i] && truth[i] > 0 && truth[i] < 1;
  }

  constexpr std::size_t kCount = std::size(kSettings);
  std::vector<double> passMs[kCount], frameMs[kCount];
  Error errors[kCount];
  double taken[kCount] = {};
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    for (std::size_t s = 0; s < kCount; ++s) {
      const std::vector<float> values = shadows.visibility(shadowsOf(source, kSettings[s]));
      errors[s] = compare(values, truth, facing);
      taken[s] = samplesTaken(values, facing, kSettings[s]);
      RenderSettings settings;
      settings.samples = 1;
      settings.shadows = shadowsOf(source, kSettings[s]);
      NullSink sink;
      const double ms = processorMs([&] {
        renderer.renderPicture(scene.view, lighting, Background{}, settings, PixelFormat::rgba8, sink);
      });
      if (repetition < 0) continue;
      passMs[s].push_back(shadows.passMs());
      frameMs[s].push_back(ms);
    }
  }
  for (std::size_t s = 0; s < kCount; ++s) {
    fmt::print("shadow,\"{}\",{},{},{},{:.5f},{:.4f},{:.2f},{:.2f},{:.1f},{:.3f}\n", source.name,
               source.penumbra, kSettings[s].name, kSettings[s].samples, errors[s].rms, errors[s].largest,
               median(passMs[s]), median(frameMs[s]), taken[s],
               static_cast<double>(penumbra) / static_cast<double>(lit));
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
  Error errors[std::size(counts)];
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (std::size_t s = 0; s < std::size(counts); ++s) {
      std::vector<float> picture;
      const double spent = processorMs([&] { picture = draw(counts[s]); });
      errors[s] = compare(picture, truth, all);
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

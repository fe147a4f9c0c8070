#include "app/measure/shadow_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <utility>

#include "app/measure/csv.h"
#include "app/measure/measure_scene.h"
#include "app/measure/null_sink.h"
#include "app/measure/statistics.h"
#include "render/renderer.h"
#include "render/shadow_scene.h"

namespace meniscus::measure {

namespace {

constexpr int kPatterns = 16, kPatternSamples = 256;  // of the truth

ShadowSettings softShadows(double penumbra, int samples, int probes) {
  return {ShadowMode::soft, penumbra, samples, probes};
}

double samplesTaken(const std::vector<float>& values, const std::vector<bool>& counts, int samples,
                    int probes) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts[i]) continue;
    const bool agreed = probes > 0 && (values[i] == 0.0f || values[i] == 1.0f);
    sum += agreed ? probes : samples;
    n += 1;
  }
  return sum / std::max(n, 1.0);
}

Row columns() {
  return {"scene", "spheres", "width",   "height",   "penumbra",      "samples",       "probes",
          "rms",   "largest", "pass_ms", "frame_ms", "samples_taken", "penumbra_share"};
}

}  // namespace

ShareError compareShares(const std::vector<float>& values, const std::vector<float>& truth,
                         const std::vector<bool>& counts) {
  ShareError error;
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

std::vector<ShadowPoint> measureShadowPoints(const std::shared_ptr<const Primitives>& primitives,
                                             const View& view, double penumbra,
                                             const std::vector<std::pair<int, int>>& settings,
                                             int repetitions, const std::function<void(double)>& progress) {
  const Lighting lighting;
  ShadowScene shadows(*primitives, view, lighting.key);
  std::vector<float> truth(shadows.depth().size(), 0.0f);
  for (int k = 0; k < kPatterns; ++k) {
    const std::vector<float> part =
        shadows.visibility(softShadows(penumbra, kPatternSamples, 0), k, kPatterns);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] += part[i] / static_cast<float>(kPatterns);
  }
  const glm::dvec3 toLight = -lighting.key.direction;
  std::vector<bool> facing(truth.size());
  std::size_t lit = 0, partly = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    facing[i] = shadows.depth()[i] > 0 && glm::dot(glm::dvec3(shadows.normal()[i]), toLight) > 0;
    lit += facing[i];
    partly += facing[i] && truth[i] > 0 && truth[i] < 1;
  }

  std::vector<ShadowPoint> points(settings.size());
  std::vector<std::vector<double>> passMs(settings.size()), frameMs(settings.size());
  Renderer renderer;
  renderer.setPrimitives(primitives);
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    for (std::size_t s = 0; s < settings.size(); ++s) {
      const auto [samples, probes] = settings[s];
      const ShadowSettings shadow = softShadows(penumbra, samples, probes);
      const std::vector<float> values = shadows.visibility(shadow);
      const ShareError error = compareShares(values, truth, facing);
      points[s].samples = samples;
      points[s].probes = probes;
      points[s].rms = error.rms;
      points[s].largest = error.largest;
      points[s].samplesTaken = samplesTaken(values, facing, samples, probes);
      RenderSettings picture;
      picture.samples = 1;
      picture.shadows = shadow;
      NullSink sink;
      const std::clock_t start = std::clock();
      renderer.renderPicture(view, lighting, Background{}, picture, PixelFormat::rgba8, sink);
      const double spent = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      if (repetition < 0) continue;
      passMs[s].push_back(shadows.passMs());
      frameMs[s].push_back(spent);
    }
    if (progress) progress((repetition + 2.0) / (repetitions + 1.0));
  }
  for (std::size_t s = 0; s < settings.size(); ++s) {
    points[s].passMs = median(passMs[s]);
    points[s].frameMs = median(frameMs[s]);
    points[s].penumbraShare =
        static_cast<double>(partly) / static_cast<double>(std::max<std::size_t>(lit, 1));
  }
  return points;
}

void measureShadows(const Sweep& sweep, const OutputFolder& folder, Progress& progress) {
  GrowingCsv table(folder / "shadows.csv", columns());
  double done = 0;
  const double count = static_cast<double>(sweep.shadows.size() * sweep.sizes.size());
  for (const ShadowSpec& spec : sweep.shadows) {
    for (const ImageSize& size : sweep.sizes) {
      const auto text = [](auto value) { return fmt::format("{}", value); };
      std::vector<std::pair<int, int>> missing;
      for (const auto& [samples, probes] : spec.settings) {
        const bool there = std::any_of(
            table.rows().begin(), table.rows().end(), [&, s = samples, p = probes](const Row& row) {
              return row[0] == spec.name && row[2] == text(size.width) && row[3] == text(size.height) &&
                     row[5] == text(s) && row[6] == text(p);
            });
        if (!there) missing.emplace_back(samples, probes);
      }
      progress.label("shadows: " + spec.name);
      progress.update(done / count);
      if (!missing.empty()) {
        const auto primitives = moleculeAs(spec.molecule, spec.representation, spec.copies);
        const View view = viewOf(*primitives, {}, size);
        const std::vector<ShadowPoint> points =
            measureShadowPoints(primitives, view, spec.penumbra, missing, sweep.repetitions,
                                [&](double share) { progress.update((done + share) / count); });
        std::vector<Row> rows;
        for (const ShadowPoint& p : points)
          rows.push_back({spec.name, text(primitives->spheres.size()), text(size.width), text(size.height),
                          numberText(spec.penumbra), text(p.samples), text(p.probes), numberText(p.rms),
                          numberText(p.largest), numberText(p.passMs), numberText(p.frameMs),
                          numberText(p.samplesTaken), numberText(p.penumbraShare)});
        table.append(rows);
      }
      ++done;
    }
  }
}

}  // namespace meniscus::measure

#pragma once
// What a run of `meniscus render` did and what it cost: for --stats and --explain.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "render/render_stats.h"

namespace meniscus {

struct PictureReport {
  std::string input, output;
  std::size_t atoms = 0, bonds = 0;  ///< of the models drawn, before copies are placed
  std::size_t spheres = 0, cylinders = 0, ellipsoids = 0, metaballs = 0, triangles = 0;  ///< all copies
  std::size_t copies = 0;          ///< that share their quadrics with others
  std::uint64_t quadricBytes = 0;  ///< of memory, beside what is made for drawing
  ImageSize size;
  int samples = 0;
};

struct RunReport {
  std::string backend, renderer;        ///< empty if no context was needed
  ImageSize size;                       ///< of the last picture, or as asked for if there is none
  int samples = 0;                      ///< likewise
  std::vector<PictureReport> pictures;  ///< every frame of a film, too
  std::vector<std::string> failures;    ///< one line each
  /// Wall time [s]; compiling, drawing and reading back are timed by the renderer.
  double parseSeconds = 0, bondsSeconds = 0, primitivesSeconds = 0, contextSeconds = 0, encodeSeconds = 0,
         meshSeconds = 0, totalSeconds = 0;
  double cpuSeconds = 0;              ///< of the process, all threads
  std::uint64_t peakMemoryBytes = 0;  ///< largest resident size
  RenderStats render;
};

/// Time of drawing alone: programs are compiled on first use, while the renderer's clock for drawing runs.
inline double drawMs(const RunReport& report) {
  return std::max(0.0, report.render.drawMs - report.render.compileMs);
}

/// Adds the time it lives to `seconds`.
class Timed {
 public:
  explicit Timed(double& seconds) : seconds_(seconds) {}
  ~Timed() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

/// Fills in totalSeconds, cpuSeconds and peakMemoryBytes from the process as it is now.
void addProcessUsage(RunReport& report);

/// Main memory of this machine; 0 if it is not known.
std::uint64_t physicalMemoryBytes();

std::string statsAsJson(const RunReport& report);
std::string explanationOf(const RunReport& report);

}  // namespace meniscus

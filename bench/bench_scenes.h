#pragma once
// What the benchmarks draw, and how they measure.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/primitives.h"
#include "core/scene.h"
#include "core/view.h"
#include "render/render_stats.h"

namespace meniscus::bench {

/// A structure of molecules/ and how often it stands beside itself.
struct SceneSource {
  std::string file;
  Representation representation = Representation::spacefill;
  glm::ivec3 copies{1};
  std::size_t atoms = 0;    ///< so many of them, in the file's order; 0 = all
  bool splitBonds = false;  ///< two cylinders for each bond, as Sigg et al. count them
};

struct BenchScene {
  std::shared_ptr<Primitives> primitives;
  View view;
};
/// Seen as `meniscus render` would see it. Throws Error if the file cannot be read.
BenchScene loadScene(const SceneSource& source, ImageSize size);

/// Takes rows and forgets them.
class NullSink : public RowSink {
 public:
  void writeRows(std::span<const std::byte>) override {}
};

double median(std::vector<double> values);

/// Processor time of a call, of all threads together [ms]: without a GPU it is what drawing costs, however
/// busy the machine is with other work.
double processorMs(const std::function<void()>& call);

/// [ms]
double wallMs(const std::function<void()>& call);

/// What a surface's method calls so; 0 if it does not.
double detail(const SurfaceStats& stats, std::string_view name);

}  // namespace meniscus::bench

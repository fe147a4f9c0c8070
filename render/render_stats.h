#pragma once
// What was done for a picture, what was left out and why, and what it cost.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace meniscus {

struct PassStats {
  std::string name;
  int runs = 0;             ///< how often (tiles x samples)
  double milliseconds = 0;  ///< all runs together, measured when RendererOptions::timePasses
  double processorMs = 0;   ///< the same in processor time of all threads
};

struct OmissionStats {
  std::string what;    ///< "pass cylinders", "channel distance"
  std::string reason;  ///< "no bonds in this scene"
};

struct ResourceStats {
  std::string name;
  std::uint64_t bytes = 0;
};

/// What a surface method did, all pixels and pictures together. "Pixels" are rays that were cast: one for
/// each pixel and sample, and each texel of a shadow map.
struct SurfaceStats {
  std::string method;                ///< and what else is worth a line: "bezier", "tiles (AVX2)"
  std::uint64_t pixels = 0;          ///< rays that met at least one ball's support
  std::uint64_t pieces = 0;          ///< polynomial pieces that were looked at
  std::uint64_t iterations = 0;      ///< of the root finder
  std::uint64_t mostIterations = 0;  ///< of one pixel
  std::uint64_t overflow = 0;        ///< pixels whose list was too short at first and that were done again
  std::uint64_t grazing = 0;  ///< pixels where a tangency could not be told from a crossing at the tolerance
  std::uint64_t notConverged = 0;  ///< pixels whose iteration ended without its tolerance
  /// What only this method counts: "balls left after culling", "layers peeled".
  std::vector<std::pair<std::string, double>> details;
  /// Adds counts, takes the larger of the largest, which details are whose name begins with "most" or
  /// "longest".
  void add(const SurfaceStats& other);
};

/// To those of the same method, if there are any.
void addStats(std::vector<SurfaceStats>& all, const SurfaceStats& some);

struct RenderStats {
  std::vector<PassStats> passes;
  std::vector<OmissionStats> omissions;
  std::vector<std::string> programs;    ///< compiled so far, by name and flags
  std::vector<ResourceStats> buffers;   ///< alive
  std::vector<ResourceStats> textures;  ///< alive
  double uploadMs = 0, compileMs = 0, drawMs = 0, readbackMs = 0;
  int tiles = 0;
  std::vector<SurfaceStats> surfaces;  ///< by method
};

}  // namespace meniscus

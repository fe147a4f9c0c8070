#pragma once
// What was done for a picture, what was left out and why, and what it cost.

#include <cstdint>
#include <string>
#include <vector>

namespace meniscus {

struct PassStats {
  std::string name;
  int runs = 0;             ///< how often (tiles x samples)
  double milliseconds = 0;  ///< all runs together, measured when RendererOptions::timePasses
};

struct OmissionStats {
  std::string what;    ///< "pass cylinders", "channel distance"
  std::string reason;  ///< "no bonds in this scene"
};

struct ResourceStats {
  std::string name;
  std::uint64_t bytes = 0;
};

struct RenderStats {
  std::vector<PassStats> passes;
  std::vector<OmissionStats> omissions;
  std::vector<std::string> programs;    ///< compiled so far, by name and flags
  std::vector<ResourceStats> buffers;   ///< alive
  std::vector<ResourceStats> textures;  ///< alive
  double uploadMs = 0, compileMs = 0, drawMs = 0, readbackMs = 0;
  int tiles = 0;
};

}  // namespace meniscus

#pragma once
// Casts the rays of a tile into its list of metaballs, by the widest vectors that the processor has.

#include <cstdint>
#include <span>

#include "core/tiles/metaball_source.h"
#include "core/tiles/tile_rays.h"

namespace meniscus::tiles {

/// Of all rays together.
struct FieldCounts {
  std::uint64_t rays = 0;            ///< that met a support, in tiles that may show something
  std::uint64_t intervals = 0;       ///< between two entries or exits, looked at by a bound of the field
  std::uint64_t stretches = 0;       ///< of several intervals, looked at likewise by a packet of rays
  std::uint64_t pieces = 0;          ///< polynomials written down
  std::uint64_t iterations = 0;      ///< of the root finder
  std::uint64_t mostIterations = 0;  ///< of one ray
  std::uint64_t splits = 0;          ///< intervals halved because several roots were possible
  std::uint64_t grazing = 0;         ///< rays with an interval that could not be split any more
  std::uint64_t notConverged = 0;
  std::uint64_t mostChords = 0;  ///< that a packet of rays had to keep at once
  void add(const FieldCounts& other);
};

struct FieldTile {
  const MetaballField* field = nullptr;
  double largestSupport = 0;  ///< sets the absolute tolerance
  std::span<const BallRecord> records;
  std::span<const std::uint32_t> list;  ///< indices into records, nearest bucket first
  float slack = 0;                      ///< of TileLists
  bool cut = false;                     ///< the list ends where cores hide what follows
};

/// A ball as a tile's rays take it: from the tile's corner, and from the plane z = zStart of view space that
/// rays are measured from.
struct TileBall {
  float x, y;         ///< its centre [pixels]
  float z;            ///< [Å], less than 0 behind the plane
  float perPixel;     ///< [Å] in the centre's plane
  float front, back;  ///< largest and smallest z
  float support2, inverse2, coefficient;
  std::uint32_t record;
  bool fromEye;
};

/// rays: of LaneOrder::squares. What is wanted of `out` is written in rows, background included. Returns
/// whether it could be done: a ray that begins inside the surface sees its far wall, for which a cut list
/// does not do.
bool castField(const FieldTile& tile, const TileRays& rays, const PlaneChannels& channels, TilePixels& out,
               FieldCounts& counts);

/// The chords of a packet of rays that may still matter, and room for as many as it takes.
class ChordWindow {
 public:
  explicit ChordWindow(std::size_t lanes);
  ~ChordWindow();
  ChordWindow(const ChordWindow&) = delete;
  ChordWindow& operator=(const ChordWindow&) = delete;
  void grow();

  std::size_t capacity = 0;
  float *middle = nullptr, *half2 = nullptr, *enter = nullptr, *leave = nullptr;  // a vector for each chord
  float *inverse2 = nullptr, *coefficient = nullptr;                              // a number for each chord
  std::uint32_t* ball = nullptr;                                                  // whose chord it is

 private:
  std::size_t lanes_;
  void* memory_ = nullptr;
};

}  // namespace meniscus::tiles

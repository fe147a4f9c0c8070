#pragma once
// What a pass can be told: plain structs with defaults, units and ranges. An effect that is off costs
// nothing.

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace meniscus {

enum class ShadowMode : std::uint8_t { off, hard, soft };

/// Shadows of the key light.
struct ShadowSettings {
  ShadowMode mode = ShadowMode::off;
  double penumbra = 2.0;  ///< width of a soft shadow's edge [Å], >= 0
  int samples = 64;       ///< of the shadow map per ray, soft shadows, 1..kMaxShadowSamples
  int probes = 16;        ///< if these agree, the others are left out; 0 = all are taken
  bool operator==(const ShadowSettings&) const = default;
};

/// Lines between neighbouring atoms, residues or chains, however their surfaces meet.
enum class LineGroups : std::uint8_t { none, chains, residues, atoms };

/// Lines where the depth or the normal jumps, and between groups of atoms.
struct SilhouetteSettings {
  bool silhouettes = false;  ///< in front of what lies behind: outlines of objects
  bool creases = false;      ///< where surfaces meet at an angle
  LineGroups groups = LineGroups::none;
  double width = 1.5;              ///< pixels of the final picture, 0.5..kMaxLineWidth
  double gap = 1.0;                ///< a smaller step in depth raises no silhouette [Å], >= 0
  double creaseAngleDeg = 30;      ///< least angle between the normals [degrees], 1..180
  std::uint32_t color = 0x000000;  ///< 0xRRGGBB, sRGB
  double strength = 1;             ///< opacity of a line, 0..1
  bool any() const { return silhouettes || creases || groups != LineGroups::none; }
  bool operator==(const SilhouetteSettings&) const = default;
};

enum class UnsharpMode : std::uint8_t {
  off,
  both,  ///< brightens what lies in front of its surroundings, darkens what lies behind
  halo   ///< only darkens what lies behind
};

/// Depth unsharp masking (Luft, Colditz, Deussen 2006).
struct DepthUnsharpSettings {
  UnsharpMode mode = UnsharpMode::off;
  double strength = 2;   ///< brightness per share of the scene's depth range, 0..100
  double radius = 0.02;  ///< standard deviation of the Gaussian, > 0; see radiusInAngstrom; at most
                         ///< kMaxUnsharpSigma pixels are used
  bool radiusInAngstrom =
      false;  ///< [Å] at the middle of the scene; else a share of the picture's smaller side
  bool operator==(const DepthUnsharpSettings&) const = default;
};

/// Fades what is far away into the background. Depths are shares of the scene's depth range, the diameter of
/// its bounding sphere: 0 = nearest, 1 = farthest.
struct FogSettings {
  double strength = 0;  ///< at `end` and beyond, 0..1; 0 = off
  double start = 0.2;   ///< < end
  double end = 1.0;
  bool operator==(const FogSettings&) const = default;
};

/// Ambient occlusion: what lies around a point takes some of the ambient and the fill light away.
struct OcclusionSettings {
  bool on = false;
  double radius = 30;   ///< [Å]; occluders count in full up to half of it and not beyond it; 0 = all count
  double strength = 1;  ///< 0..1
  int directions = 64;  ///< from which light comes: a multiple of 8, 8..kMaxOcclusionDirections
  double texelSize = 0.5;  ///< of the maps [Å], > 0; larger where a pixel is, or where memory demands it
  bool operator==(const OcclusionSettings&) const = default;
};

class EnvironmentMap;

/// What mirrors and glass show where nothing is met.
enum class Environment : std::uint8_t {
  sky,         ///< procedural: bright at the horizon, blue above, brown below (core/traced_light.h)
  background,  ///< the picture's background colour
  map          ///< TraceSettings::environmentMap
};

/// Rays from what is seen (core/traced_light.h): exact, and slow beside what they replace.
struct TraceSettings {
  int shadows = 0;     ///< rays per pixel to the key light, in place of a shadow map; 0 = off
  int occlusion = 0;   ///< rays per pixel to the sky, in place of occlusion maps; 0 = off
  int reflect = 0;     ///< surfaces mirror what is around them, so often one after the other; 0 = off
  int refract = 0;     ///< surfaces are of glass, of which a ray passes so many walls; 0 = off
  double index = 1.5;  ///< of refraction, 1..kMostIndex; also says how strongly surfaces mirror
  std::uint32_t attenuationColor = 0xFFFFFF;  ///< sRGB: of white light behind attenuationDistance of glass
  double attenuationDistance = 10;            ///< [Å], > 0
  Environment environment = Environment::sky;
  std::shared_ptr<const EnvironmentMap> environmentMap = {};  ///< not null if that is the environment
  bool light() const { return reflect > 0 || refract > 0; }
  bool any() const { return shadows > 0 || occlusion > 0 || light(); }
  bool operator==(const TraceSettings&) const = default;
};

/// How spheres, cylinders and ellipsoids are drawn.
enum class QuadricMethod : std::uint8_t {
  splat,      ///< a rectangle for each, by the GPU (render/quadrics.h)
  tiles,      ///< from tile lists, by the processor (render/tile_quadrics.h)
  tilesGlsl,  ///< from the same lists, by shaders (render/tile_quadrics_glsl.h)
  automatic   ///< tiles where OpenGL itself runs on the processor, else splat
};

/// How metaball surfaces are drawn; which methods and parameters there are: render/surface_method.h.
struct SurfaceSettings {
  std::string method = "auto";
  std::map<std::string, double> parameters;  ///< those that are not the method's defaults
  double opacity = 1;  ///< 0..1 of a place where a ray crosses a surface; below 1 it is translucent
  bool translucent() const { return opacity < 1; }
  bool operator==(const SurfaceSettings&) const = default;
};

struct RenderSettings {
  int samples =
      16;  ///< rays per pixel, 1..kMaxSamples; fixed positions, so the same command gives the same bytes
  ShadowSettings shadows;
  OcclusionSettings occlusion;
  SilhouetteSettings lines;
  DepthUnsharpSettings depthUnsharp;
  FogSettings fog;
  QuadricMethod quadrics = QuadricMethod::automatic;
  bool levelOfDetail = true;  ///< of quadrics: core/tiles/detail_levels.h
  SurfaceSettings surface;
  TraceSettings trace;
  bool operator==(const RenderSettings&) const = default;
};

inline constexpr int kMaxSamples = 256;
inline constexpr int kMaxShadowSamples = 256;
inline constexpr int kMaxTracedRays = 4096;
inline constexpr int kMaxBounces = 16;
inline constexpr double kMostIndex = 10;
inline constexpr int kMaxOcclusionDirections = 128;
inline constexpr double kMaxLineWidth = 16;
inline constexpr double kMaxUnsharpSigma = 340;

}  // namespace meniscus

// The list of surface methods, and how one is chosen.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/gl/objects.h"
#include "render/surface/bezier.h"
#include "render/surface/bvh.h"
#include "render/surface/lists.h"
#include "render/surface/mesh.h"
#include "render/surface/newton.h"
#include "render/surface/tiles.h"
#include "render/surface/tiles_glsl.h"
#include "render/surface_method.h"

namespace meniscus {

std::span<const SurfaceMethodInfo> surfaceMethods() {
  static const SurfaceMethodInfo kMethods[] = {
      {"tiles",
       "exact, by the processor, from lists of each screen tile (docs/methods.md)",
       {},
       makeTiles,
       false,
       true},
      {"tiles_glsl", "the same lists, cast by shaders: exact, for a GPU", tilesGlslParameters(),
       makeTilesGlsl},
      {"bezier", "depth-peeled Bezier clipping (Kanamori, Szego and Nishita 2008)", bezierParameters(),
       makeBezier},
      {"lists", "fragment lists (Szecsi and Illes 2012)", listsParameters(), makeLists, true},
      {"newton", "hulls and Newton's method (SIGGRAPH 2006 poster), with a bracket around the first root",
       newtonParameters(), makeNewton},
      {"bvh", "a fitted tree, for rays from anywhere (Gourmel et al. 2010)", bvhParameters(), makeBvh},
      {"mesh", "triangles by marching cubes; as exact as --mesh-spacing is fine", meshParameters(), makeMesh},
  };
  return kMethods;
}

const SurfaceMethodInfo& surfaceMethodFor(const SurfaceSettings& settings) {
  const std::span<const SurfaceMethodInfo> methods = surfaceMethods();
  const auto suits = [&](const SurfaceMethodInfo& method) {
    return method.translucent || !settings.translucent();
  };
  if (settings.method == "auto") return *std::find_if(methods.begin(), methods.end(), suits);
  std::string names = "auto";
  for (const SurfaceMethodInfo& method : methods) {
    if (method.name == settings.method && !suits(method))
      throw UsageError(
          fmt::format("--opacity: the method {} draws opaque surfaces only; leave out "
                      "--surface-method or give lists",
                      method.name));
    if (method.name == settings.method) return method;
    names += fmt::format(", {}", method.name);
  }
  throw UsageError(fmt::format("--surface-method: there is no '{}'; there are {}", settings.method, names));
}

std::string surfaceReason(const SurfaceSettings& settings) {
  if (settings.method != "auto") return "--surface-method " + settings.method;
  if (settings.translucent()) return "auto takes lists: it draws the layers of translucent surfaces";
  const gl::Device device = gl::queryDevice();
  const std::string taken = fmt::format("auto takes {}: it is exact and ", surfaceMethodFor(settings).name);
  return taken + (device.software
                      ? "by far the fastest where, as here, " + device.name + " runs on the processor"
                      : "nothing faster has been measured on a GPU such as " + device.name);
}

SurfaceParameters surfaceParametersFor(const SurfaceMethodInfo& method, const SurfaceSettings& settings) {
  SurfaceParameters values;
  std::string names;
  for (const SurfaceParameter& parameter : method.parameters) {
    values.emplace(parameter.name, parameter.value);
    names += (names.empty() ? "" : ", ") + std::string(parameter.name);
  }
  for (const auto& [name, value] : settings.parameters) {
    const auto found = values.find(name);
    if (found == values.end())
      throw UsageError(fmt::format("--surface-option: the method {} has no '{}'; it has {}", method.name,
                                   name, names.empty() ? "no options" : names));
    for (const SurfaceParameter& parameter : method.parameters) {
      if (parameter.name != name) continue;
      const bool allowed = value >= parameter.least && value <= parameter.most &&
                           (!parameter.whole || value == std::floor(value));
      if (!allowed)
        throw UsageError(fmt::format("--surface-option: {}={} is not allowed; give a {}number from {} to {}",
                                     name, value, parameter.whole ? "whole " : "", parameter.least,
                                     parameter.most));
    }
    found->second = value;
  }
  return values;
}

}  // namespace meniscus

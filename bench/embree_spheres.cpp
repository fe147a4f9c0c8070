#include "bench/embree_spheres.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "bench/bench_scenes.h"

namespace meniscus::bench {

namespace {

constexpr int kTile = 8;

void castRow(RTCScene scene, const View& view, const glm::dvec3& shift, int x0, int y, float* out) {
  RTCRayHit8 r;
  alignas(32) int valid[8];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const glm::dmat3 back = glm::transpose(view.rotation);
  for (int i = 0; i < 8; ++i) {
    const Ray ray = rayThrough(view, {x0 + i + 0.5, y + 0.5});
    const glm::vec3 origin(back * ray.origin + shift), direction(back * ray.direction);
    valid[i] = x0 + i < view.size.width ? -1 : 0;
    r.ray.org_x[i] = origin.x;
    r.ray.org_y[i] = origin.y;
    r.ray.org_z[i] = origin.z;
    r.ray.dir_x[i] = direction.x;
    r.ray.dir_y[i] = direction.y;
    r.ray.dir_z[i] = direction.z;
    r.ray.tnear[i] = 0;
    r.ray.tfar[i] = std::numeric_limits<float>::infinity();
    r.ray.time[i] = 0;
    r.ray.mask[i] = ~0u;
    r.ray.flags[i] = 0;
    r.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid, scene, &context, &r);
  for (int i = 0; i < 8; ++i) {
    if (valid[i] == 0) continue;
    out[i] =
        r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? r.ray.tfar[i] : std::numeric_limits<float>::infinity();
  }
}

}  // namespace

EmbreeTimes castByEmbree(const Primitives& primitives, const View& view) {
  EmbreeTimes times;
  const RTCDevice device = rtcNewDevice(nullptr);
  const RTCScene scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const std::size_t count = primitives.spheres.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, count));
  for (std::size_t i = 0; i < count; ++i) {
    const SpherePrimitive& s = primitives.spheres[i];
    for (int k = 0; k < 3; ++k) vertices[4 * i + static_cast<std::size_t>(k)] = s.center[k];
    vertices[4 * i + 3] = s.radius;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  times.buildMs = timeMs([&] { rtcCommitScene(scene); });

  const int width = view.size.width, height = view.size.height;
  const int tilesX = (width + kTile - 1) / kTile, tilesY = (height + kTile - 1) / kTile;
  times.distance.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const glm::dvec3 shift = view.pivot - primitives.origin;
  times.castMs = timeMs([&] {
    tbb::parallel_for(0, tilesX * tilesY, [&](int tile) {
      const int x = tile % tilesX * kTile, y0 = tile / tilesX * kTile;
      for (int y = y0; y < std::min(y0 + kTile, height); ++y)
        castRow(scene, view, shift, x, y, times.distance.data() + static_cast<std::ptrdiff_t>(y) * width + x);
    });
  });
  times.hits =
      static_cast<std::size_t>(std::count_if(times.distance.begin(), times.distance.end(), [](float d) {
        return d < std::numeric_limits<float>::infinity();
      }));
  rtcReleaseGeometry(geometry);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return times;
}

}  // namespace meniscus::bench

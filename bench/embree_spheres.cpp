#include "bench/embree_spheres.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace meniscus::bench {

namespace {

constexpr int kTile = 8;

// A picture's rays in single precision, made as cheaply as any: along a row, directions change by a constant.
struct FloatRays {
  glm::vec3 origin, corner, right, up;  // world axes, relative to the primitives' origin

  FloatRays(const View& view, const glm::dvec3& shift) {
    const glm::dmat3 back = glm::transpose(view.rotation);
    const glm::dvec2 offset = (glm::dvec2(0.5) - view.center) * view.pixelSize;
    origin = glm::vec3(back * glm::dvec3(0, 0, view.distance) + shift);
    corner = glm::vec3(back * glm::dvec3(offset, -1));
    right = glm::vec3(back[0] * view.pixelSize);
    up = glm::vec3(back[1] * view.pixelSize);
  }
};

void castRow(RTCScene scene, const FloatRays& rays, int width, int x0, int y, float* out) {
  alignas(32) RTCRayHit8 r;
  alignas(32) int valid[8];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const glm::vec3 start = rays.corner + static_cast<float>(y) * rays.up;
  for (int i = 0; i < 8; ++i) {
    const auto x = static_cast<float>(x0 + i);
    const float dx = start.x + x * rays.right.x, dy = start.y + x * rays.right.y,
                dz = start.z + x * rays.right.z;
    const float inverse = 1.0f / std::sqrt(dx * dx + dy * dy + dz * dz);
    valid[i] = x0 + i < width ? -1 : 0;
    r.ray.org_x[i] = rays.origin.x;
    r.ray.org_y[i] = rays.origin.y;
    r.ray.org_z[i] = rays.origin.z;
    r.ray.dir_x[i] = dx * inverse;
    r.ray.dir_y[i] = dy * inverse;
    r.ray.dir_z[i] = dz * inverse;
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

struct EmbreeSpheres::Handles {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
};

EmbreeSpheres::EmbreeSpheres(const Primitives& primitives)
    : handles_(std::make_unique<Handles>()), origin_(primitives.origin) {
  const RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const std::size_t count = primitives.spheres.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, count));
  for (std::size_t i = 0; i < count; ++i) {
    const SpherePrimitive& s = primitives.spheres[i];
    for (int k = 0; k < 3; ++k) vertices[4 * i + static_cast<std::size_t>(k)] = s.center[k];
    vertices[4 * i + 3] = s.radius;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(handles_->scene, geometry);
  rtcReleaseGeometry(geometry);
}

EmbreeSpheres::~EmbreeSpheres() {
  rtcReleaseScene(handles_->scene);
  rtcReleaseDevice(handles_->device);
}

void EmbreeSpheres::build() {
  rtcCommitScene(handles_->scene);
}

void EmbreeSpheres::cast(const View& view) {
  const int width = view.size.width, height = view.size.height;
  const int tilesX = (width + kTile - 1) / kTile, tilesY = (height + kTile - 1) / kTile;
  distance_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  MENISCUS_CHECK(view.projection == Projection::perspective);
  const FloatRays rays(view, view.pivot - origin_);
  tbb::parallel_for(0, tilesX * tilesY, [&](int tile) {
    const int x = tile % tilesX * kTile, y0 = tile / tilesX * kTile;
    for (int y = y0; y < std::min(y0 + kTile, height); ++y)
      castRow(handles_->scene, rays, width, x, y,
              distance_.data() + static_cast<std::ptrdiff_t>(y) * width + x);
  });
}

}  // namespace meniscus::bench

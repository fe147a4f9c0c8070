#include "core/reference_tracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/reference_ray.h"

namespace meniscus {

namespace {

using reference::RayHit;
using reference::RayScratch;
using reference::Verdict;
using reference::ViewBall;
using reference::ViewRay;
using Long3 = glm::vec<3, long double, glm::defaultp>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Long3 turned(const glm::dmat3& rotation, const Long3& v) {
  Long3 out(0);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      out[row] += static_cast<long double>(rotation[column][row]) * v[column];
  return out;
}

/// A ray as core/view.h defines it, in extended precision: rayThrough() rounds its direction, which is 1e-11
/// Å at 1e5 Å.
struct LongRay {
  Long3 origin, direction;
};

LongRay longRay(const View& view, glm::dvec2 pixel) {
  const long double scale = view.pixelSize, x = (pixel.x - static_cast<long double>(view.center.x)) * scale,
                    y = (pixel.y - static_cast<long double>(view.center.y)) * scale;
  if (view.projection == Projection::orthographic) return {{x, y, view.nearZ}, {0, 0, -1}};
  return {{0, 0, view.distance}, glm::normalize(Long3(x, y, -1))};
}

/// All rays of some pixels lie in a cone from the eye or, orthographic, in a cylinder.
struct SurfaceBeam {
  bool cone = true;
  glm::dvec3 apex{0.0}, axis{0.0, 0.0, -1.0};
  double sine = 0, cosine = 1;  ///< of the cone's half angle
  double radius = 0;            ///< of the cylinder
  bool everything = false;      ///< wider than a half space

  /// Never false for a ball whose support one of the rays meets.
  bool meets(const glm::dvec3& center, double reach) const {
    if (everything) return true;
    const glm::dvec3 v = center - apex;
    const double along = glm::dot(v, axis), aside = glm::length(v - along * axis);
    const double slack = 1e-9 * reach + 1e-12 * (std::abs(along) + aside);
    if (!cone) return aside <= radius + reach + slack;
    // The plane that touches the cone on the ball's side; the plane across the axis through the eye.
    return aside * cosine - along * sine <= reach + slack && along >= -reach - slack;
  }
};

/// A field as a view sees it. Centres are relative to the middle of the field, so that neither its place in
/// the world nor the distance of the eye costs digits.
class FieldInView {
 public:
  FieldInView(const MetaballField& field, const glm::dvec3& origin, const View& view, double shift);

  const MetaballField& field() const { return field_; }
  const std::vector<ViewBall>& balls() const { return balls_; }
  ViewRay rayOf(const View& view, glm::dvec2 pixel, double shift) const;
  SurfaceBeam beamOf(const View& view, glm::dvec2 low, glm::dvec2 high) const;

 private:
  const MetaballField& field_;
  Long3 middle_{0};              ///< view space
  std::vector<ViewBall> balls_;  ///< by ascending `nearest`
};

FieldInView::FieldInView(const MetaballField& field, const glm::dvec3& origin, const View& view, double shift)
    : field_(field) {
  if (field.balls.empty()) return;
  glm::vec3 low = field.balls.front().center, high = low;
  for (const Metaball& ball : field.balls) {
    low = glm::min(low, ball.center);
    high = glm::max(high, ball.center);
  }
  const glm::dvec3 middle = (glm::dvec3(low) + glm::dvec3(high)) / 2.0;
  middle_ = turned(view.rotation, Long3(origin) - Long3(view.pivot) + Long3(middle));

  const bool perspective = view.projection == Projection::perspective;
  balls_.reserve(field.balls.size());
  for (std::size_t i = 0; i < field.balls.size(); ++i) {
    const Metaball& ball = field.balls[i];
    const Long3 offset = turned(view.rotation, Long3(ball.center) - Long3(middle));
    const double support = ball.support;
    // From the eye, or the near plane, to the centre.
    const double away = perspective
                            ? static_cast<double>(glm::length(middle_ + offset - Long3(0, 0, view.distance)))
                            : static_cast<double>(view.nearZ - middle_.z - offset.z);
    // At unit depth two rays are `shift` apart, at distance t at most t times as much, and in the support t
    // is at most away + support + spread.
    const double spread = perspective ? shift * (away + support) / (1 - shift) : shift;
    const double rounding = 1e-12 * (std::abs(away) + support);
    balls_.push_back({glm::dvec3(offset), support, ball.coefficient, away - support - spread - rounding,
                      spread * (1 + 1e-9), static_cast<std::uint32_t>(i)});
  }
  std::stable_sort(balls_.begin(), balls_.end(),
                   [](const ViewBall& a, const ViewBall& b) { return a.nearest < b.nearest; });
}

ViewRay FieldInView::rayOf(const View& view, glm::dvec2 pixel, double shift) const {
  const LongRay ray = longRay(view, pixel);
  ViewRay out;
  out.direction = glm::dvec3(ray.direction);
  out.distance0 = static_cast<double>(glm::dot(middle_ - ray.origin, ray.direction));
  out.base = glm::dvec3(ray.origin + static_cast<long double>(out.distance0) * ray.direction - middle_);
  double start = 0;
  if (view.projection == Projection::perspective) {
    const double depth = view.distance - view.nearZ, slope = -out.direction.z;
    start = std::max(depth / slope, 0.0);
    // The directions' z differ by at most shift.
    out.startSpread = slope > 2 * shift ? start * shift / (slope - shift) : start;
  }
  out.start = start - out.distance0;
  return out;
}

SurfaceBeam FieldInView::beamOf(const View& view, glm::dvec2 low, glm::dvec2 high) const {
  const LongRay axis = longRay(view, (low + high) / 2.0);
  SurfaceBeam beam;
  beam.cone = view.projection == Projection::perspective;
  beam.apex = glm::dvec3(axis.origin - middle_);
  beam.axis = glm::dvec3(axis.direction);
  for (const glm::dvec2 corner : {low, high, glm::dvec2(low.x, high.y), glm::dvec2(high.x, low.y)}) {
    const LongRay ray = longRay(view, corner);
    beam.radius = std::max(beam.radius, static_cast<double>(glm::length(ray.origin - axis.origin)));
    if (glm::dot(ray.direction, axis.direction) <= 0) beam.everything = true;
    beam.sine =
        std::max(beam.sine, static_cast<double>(glm::length(glm::cross(ray.direction, axis.direction))));
  }
  beam.sine = std::min(beam.sine * (1 + 1e-9), 1.0);
  beam.cosine = std::sqrt((1 - beam.sine) * (1 + beam.sine));
  return beam;
}

/// What one ray meets first in all fields.
struct Nearest {
  RayHit hit;  ///< distance infinite if it meets nothing
  std::uint32_t id = 0;
  std::uint32_t pieces = 0;
  bool touched = false;
};

/// Casts the rays of one tile of pixels.
class TileCaster {
 public:
  TileCaster(std::span<const FieldInView> fields, const View& view, const ReferenceOptions& options)
      : fields_(fields), view_(view), options_(options), shift_(options.grazingShift * view.pixelSize) {
    candidates_.resize(fields.size());
  }

  std::vector<std::uint32_t>& candidatesOf(std::size_t field) { return candidates_[field]; }

  struct Pixel {
    Nearest nearest;
    bool grazing = false, shifted = false;
  };
  Pixel cast(glm::dvec2 pixel);

 private:
  bool castAll(glm::dvec2 pixel, bool tube, Nearest& out);
  bool otherSheet(const Nearest& a, const Nearest& b) const;

  std::span<const FieldInView> fields_;
  const View& view_;
  const ReferenceOptions& options_;
  double shift_;  ///< grazingShift at unit depth or, orthographic, in Å
  std::vector<std::vector<std::uint32_t>> candidates_;
  RayScratch scratch_;
};

// False if the rays of a tube may decide differently.
bool TileCaster::castAll(glm::dvec2 pixel, bool tube, Nearest& out) {
  out = {};
  out.hit.distance = kInfinity;
  double limit = kInfinity;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (candidates_[i].empty()) continue;
    const FieldInView& field = fields_[i];
    const ViewRay ray = field.rayOf(view_, pixel, tube ? shift_ : 0);
    const RayHit hit =
        reference::castRay(field.field(), field.balls(), candidates_[i], ray, tube, limit, scratch_);
    if (hit.verdict == Verdict::undecided) return false;
    out.pieces += hit.pieces;
    out.touched |= hit.touched;
    if (hit.verdict == Verdict::miss) continue;
    limit = std::min(limit, hit.latest);
    if (hit.distance >= out.hit.distance) continue;
    out.hit = hit;
    out.id = field.field().balls[hit.ball].id;
  }
  return true;
}

// Whether b, of a ray moved from that of a, is not the same sheet of the surface (ReferenceImage).
bool TileCaster::otherSheet(const Nearest& a, const Nearest& b) const {
  if (a.hit.verdict != b.hit.verdict) return true;
  if (a.hit.verdict == Verdict::miss) return false;
  if (a.hit.fromInside != b.hit.fromInside) return true;
  const auto tangent = [](const RayHit& hit) {
    const double cosine = std::abs(hit.cosine);
    return cosine > 0 ? std::sqrt(std::max(1 - cosine * cosine, 0.0)) / cosine : kInfinity;
  };
  const double t0 = a.hit.distance, t1 = b.hit.distance;
  const double apart = view_.projection == Projection::perspective ? shift_ * std::max(t0, t1) : shift_;
  const double rounding = 1e-13 * std::max(t0, t1);
  return std::abs(t1 - t0) > (1 + 3 * std::min(tangent(a.hit), tangent(b.hit))) * apart + rounding;
}

TileCaster::Pixel TileCaster::cast(glm::dvec2 pixel) {
  Pixel out;
  // The proof first: it fails near silhouettes and folds only.
  if (options_.grazing && shift_ < 0.5 && castAll(pixel, true, out.nearest)) return out;
  castAll(pixel, false, out.nearest);
  out.grazing = out.nearest.touched;
  if (!options_.grazing) return out;
  out.shifted = true;
  const double s = options_.grazingShift;
  for (const glm::dvec2 move : {glm::dvec2(s, 0), glm::dvec2(-s, 0), glm::dvec2(0, s), glm::dvec2(0, -s)}) {
    if (out.grazing) break;
    Nearest moved;
    castAll(pixel + move, false, moved);
    out.grazing = otherSheet(out.nearest, moved);
  }
  return out;
}

constexpr int kBeamTile = 8, kBlock = 8;  // pixels in a tile, tiles in a block, along each side

/// Fills the picture block by block; tiles are filtered from their block's balls, which keeps their order.
class PictureTracer {
 public:
  PictureTracer(std::span<const FieldInView> fields, const View& view, const ReferenceOptions& options,
                ReferenceImage& image)
      : fields_(fields), view_(view), options_(options), image_(image) {}

  void trace() {
    const int blocksX = (view_.size.width + kBeamTile * kBlock - 1) / (kBeamTile * kBlock);
    const int blocksY = (view_.size.height + kBeamTile * kBlock - 1) / (kBeamTile * kBlock);
    tbb::parallel_for(tbb::blocked_range2d<int>(0, blocksY, 1, 0, blocksX, 1), [&](const auto& range) {
      for (int y = range.rows().begin(); y < range.rows().end(); ++y)
        for (int x = range.cols().begin(); x < range.cols().end(); ++x) traceBlock(x, y);
    });
    image_.undecidedPixels = undecided_;
    image_.shiftedPixels = shifted_;
  }

 private:
  SurfaceBeam beamOf(const FieldInView& field, int x, int y, int pixels) const {
    const double margin = options_.grazing ? options_.grazingShift : 0;
    return field.beamOf(view_, glm::dvec2(x, y) - margin, glm::dvec2(x + pixels, y + pixels) + margin);
  }
  void traceBlock(int blockX, int blockY);
  void traceTile(int x0, int y0, TileCaster& caster);
  void store(int x, int y, const TileCaster::Pixel& pixel);

  std::span<const FieldInView> fields_;
  const View& view_;
  const ReferenceOptions& options_;
  ReferenceImage& image_;
  std::atomic<std::size_t> undecided_ = 0, shifted_ = 0;
};

void PictureTracer::traceBlock(int blockX, int blockY) {
  const int side = kBeamTile * kBlock, left = blockX * side, bottom = blockY * side;
  std::vector<std::vector<std::uint32_t>> inBlock(fields_.size());
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const SurfaceBeam beam = beamOf(fields_[f], left, bottom, side);
    const std::vector<ViewBall>& balls = fields_[f].balls();
    for (std::uint32_t i = 0; i < balls.size(); ++i)
      if (beam.meets(balls[i].center, balls[i].support)) inBlock[f].push_back(i);
  }
  tbb::parallel_for(tbb::blocked_range2d<int>(0, kBlock, 1, 0, kBlock, 1), [&](const auto& range) {
    TileCaster caster(fields_, view_, options_);
    for (int ty = range.rows().begin(); ty < range.rows().end(); ++ty) {
      for (int tx = range.cols().begin(); tx < range.cols().end(); ++tx) {
        const int x0 = left + tx * kBeamTile, y0 = bottom + ty * kBeamTile;
        for (std::size_t f = 0; f < fields_.size(); ++f) {
          const SurfaceBeam beam = beamOf(fields_[f], x0, y0, kBeamTile);
          std::vector<std::uint32_t>& candidates = caster.candidatesOf(f);
          candidates.clear();
          for (const std::uint32_t i : inBlock[f]) {
            const ViewBall& ball = fields_[f].balls()[i];
            if (beam.meets(ball.center, ball.support)) candidates.push_back(i);
          }
        }
        traceTile(x0, y0, caster);
      }
    }
  });
}

void PictureTracer::traceTile(int x0, int y0, TileCaster& caster) {
  const int x1 = std::min(x0 + kBeamTile, view_.size.width), y1 = std::min(y0 + kBeamTile, view_.size.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) store(x, y, caster.cast(glm::dvec2(x + 0.5, y + 0.5)));
}

void PictureTracer::store(int x, int y, const TileCaster::Pixel& pixel) {
  const auto at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.size.width) + static_cast<std::size_t>(x);
  const RayHit& hit = pixel.nearest.hit;
  image_.distance[at] = hit.distance;
  image_.hits.distance[at] = static_cast<float>(hit.distance);
  image_.hits.normal[at] = glm::vec3(hit.normal);
  image_.hits.id[at] = pixel.nearest.id;
  image_.pieces[at] = pixel.nearest.pieces;
  image_.grazing[at] = pixel.grazing ? 1 : 0;
  if (pixel.nearest.touched) ++undecided_;
  if (pixel.shifted) ++shifted_;
}

}  // namespace

ReferenceImage traceReference(std::span<const MetaballField> fields, const glm::dvec3& origin,
                              const View& view, const ReferenceOptions& options) {
  std::vector<FieldInView> inView;
  inView.reserve(fields.size());
  for (const MetaballField& field : fields) {
    requireValid(field, "reference tracer");
    inView.emplace_back(field, origin, view, options.grazing ? options.grazingShift * view.pixelSize : 0);
  }
  const std::size_t pixels = static_cast<std::size_t>(std::max(view.size.width, 0)) *
                             static_cast<std::size_t>(std::max(view.size.height, 0));
  ReferenceImage image;
  image.hits.size = view.size;
  image.hits.distance.resize(pixels);
  image.hits.normal.resize(pixels);
  image.hits.id.resize(pixels);
  image.distance.resize(pixels);
  image.pieces.resize(pixels);
  image.grazing.resize(pixels);
  PictureTracer(inView, view, options, image).trace();
  return image;
}

ReferenceImage traceReference(const MetaballField& field, const glm::dvec3& origin, const View& view,
                              const ReferenceOptions& options) {
  return traceReference(std::span(&field, 1), origin, view, options);
}

}  // namespace meniscus

#include "core/effects/shading.h"

#include <algorithm>
#include <cstring>

#include "core/effects/rows.h"
#include "core/error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/shading.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/effects/power_lanes.inl"
#include "core/effects/surface_lanes.inl"

#ifndef MENISCUS_SHADING_ONCE
#define MENISCUS_SHADING_ONCE
namespace meniscus::effects {
struct ShadeTask {
  const SurfacePlanes* planes;
  const ShadeBlock* block;
  const LightPlanes* light;
  Nearness nearness;
  float leastSquare;  // of a highlight's cosine
  float perFull;      // a highlight is whole where the key light times this is 1
};
struct EncodeTask {
  float perSample;
  glm::vec4 backdrop;
  PixelFormat format;
  const std::byte* nothing;  // a row of backdrop as it is stored, once it is known
};
/// A row's light: of each channel.
struct LightRow {
  float *red, *green, *blue, *alpha;
};
struct LitRow {
  const float *red, *green, *blue, *alpha;
};
}  // namespace meniscus::effects
#endif

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {
namespace {

struct Light {
  Vec3 color;
  V alpha;
};

constexpr float kUnorm16 = 1.0f / 65535.0f;
HWY_INLINE V loadShares(const std::uint16_t* from, std::size_t count) {
  return hn::ConvertTo(F(), hn::PromoteTo(I(), loadSome(U16(), from, count))) * all(kUnorm16);
}
template <typename T>
HWY_INLINE V loadStrided(const T* from, std::size_t count, std::size_t stride, float unit) {
  alignas(64) float values[kMostLanes] = {};
  for (std::size_t k = 0; k < count; ++k) values[k] = static_cast<float>(from[k * stride]);
  return hn::Load(F(), values) * all(unit);
}

// lit() of include/lighting.glsl. toEye(): unit vectors.
template <typename ToEye>
HWY_INLINE Vec3 lit(const ShadeTask& task, const Vec3& albedo, const Vec3& normal, ToEye toEye, V visible,
                    V sky) {
  const F f;
  const ShadeBlock& b = *task.block;
  const V zero = hn::Zero(f);
  const V key = hn::Max(dot(normal, xyz(b.key)), zero) * all(b.key.w) * visible;
  const V fill = hn::Max(dot(normal, xyz(b.fill)), zero) * all(b.fill.w);
  const V around = (fill + all(b.ambient.x)) * sky;
  const Vec3 diffuse = scale(albedo, key + around);
  const M reached = key > zero;
  if (!(b.ambient.y > 0) || hn::AllFalse(f, reached)) return diffuse;
  const Vec3 halfway = add(add(xyz(b.key), toEye()), {zero, zero, all(1e-6f)});
  const V cosine = hn::Max(dot(normal, halfway), zero);  // times halfway's length
  const V square = cosine * cosine / dot(halfway, halfway), least = all(task.leastSquare);
  const M bright = hn::And(reached, square > least);
  if (hn::AllFalse(f, bright)) return diffuse;
  const V mirrored = powerOfShare(hn::Max(square, least), 0.5f * b.ambient.z);
  const V fade = all(b.key.w) * hn::Min(key * all(task.perFull), all(1.0f));
  const V highlight = hn::IfThenElseZero(bright, all(b.ambient.y) * mirrored * fade);
  return add(diffuse, {highlight, highlight, highlight});
}

HWY_INLINE Vec3 linearAlbedo(const ShadeTask& task, std::size_t at) {
  const F f;
  const U u;
  const auto stored = hn::LoadU(u, task.planes->albedo.data() + at);
  const auto channel = [&](auto bits) {
    const auto value = hn::BitCast(I(), hn::And(bits, hn::Set(u, 0xFFu)));
    return hn::GatherIndex(f, &task.block->linear[0].x, hn::ShiftLeft<2>(value));
  };
  return {channel(stored), channel(hn::ShiftRight<8>(stored)), channel(hn::ShiftRight<16>(stored))};
}

// Of the pixels (x, y), (x + 1, y), ... from `at` on, `count` of which are the planes'.
HWY_INLINE Light surfaceLight(const ShadeTask& task, std::size_t at, int x, int y, std::size_t count,
                              V depth) {
  const F f;
  const V zero = hn::Zero(f), one = all(1.0f);
  const SurfacePlanes& planes = *task.planes;
  const ShadeBlock& b = *task.block;
  const LightPlanes& light = *task.light;
  const auto toEye = [&] {
    if (!(planes.view.scale.z > 0.5f)) return Vec3{zero, zero, one};
    const Slopes slopes = slopesAt(planes, x, y);
    return normalized({hn::Neg(slopes.x), hn::Neg(slopes.y), one});
  };
  V visible = one, sky = one;
  if (!light.visibility.empty()) visible = loadShares(light.visibility.data() + at, count);
  if (!light.occlusion.empty()) {
    const auto stored = loadSome(U(), light.occlusion.data() + at, count);
    const auto half = [](auto bits) { return hn::ConvertTo(F(), hn::BitCast(I(), bits)) * all(kUnorm16); };
    const V hidden = half(hn::And(stored, hn::Set(U(), 0xFFFFu))), whole = half(hn::ShiftRight<16>(stored));
    sky = one - all(b.ambient.w) * hn::Min(hidden / hn::Max(whole, all(1e-5f)), one);
  }
  Light l{lit(task, linearAlbedo(task, at), normalsAt(planes, at), toEye, visible, sky), one};
  if (!light.traced.empty()) {
    const float* traced = light.traced.data() + 4 * at;
    const auto channel = [&](std::size_t c) { return loadStrided(traced + c, count, 4, 1); };
    l.color = add(scale(l.color, channel(3)), {channel(0), channel(1), channel(2)});
  }
  if (!light.difference.empty()) {
    const V shift =
        hn::Min(all(b.unsharp.x) * loadSome(f, light.difference.data() + at, count), all(b.unsharp.y));
    const auto shifted = [&](V c) {
      const V root = hn::Max(hn::Sqrt(c) + shift, zero);
      return root * root;
    };
    l.color = {shifted(l.color.x), shifted(l.color.y), shifted(l.color.z)};
  }
  if (b.fog.x > 0) {
    const V away = one - nearnessOf(task.nearness, depth);
    const V fog = all(b.fog.x) * hn::Min(hn::Max((away - all(b.fog.y)) * all(b.fog.z), zero), one);
    const V through = one - fog;
    l = {scale(l.color, through), l.alpha * through};
  }
  if (!light.lines.empty()) {
    const V share = all(b.line.w) * loadShares(light.lines.data() + at, count);
    l.color = {mixed(l.color.x, all(b.line.x) * l.alpha, share),
               mixed(l.color.y, all(b.line.y) * l.alpha, share),
               mixed(l.color.z, all(b.line.z) * l.alpha, share)};
  }
  return l;
}

// A row of the planes. add: to what is there.
void shadeRow(const ShadeTask& task, int y, bool add, const LightRow& out) {
  const F f;
  const V zero = hn::Zero(f);
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  const std::size_t first = planes.rowStart(y);
  for (int x = 0; x < planes.width; x += lanes) {
    const auto column = static_cast<std::size_t>(x);
    const std::size_t at = first + column;
    const auto count = static_cast<std::size_t>(std::min(lanes, planes.width - x));
    const M inside = hn::FirstN(f, count);
    const V depth = hn::LoadU(f, planes.depth.data() + at);
    const M there = hn::And(depth > zero, inside);
    Light l{{zero, zero, zero}, zero};
    if (!hn::AllFalse(f, there)) {
      l = surfaceLight(task, at, x, y, count, depth);
      l = {choose(there, l.color, {zero, zero, zero}), hn::IfThenElseZero(there, l.alpha)};
    } else if (add && task.light->labels.empty()) {
      continue;
    }
    if (!task.light->labels.empty()) {
      const std::uint16_t* label = task.light->labels.data() + 4 * at;
      const auto channel = [&](std::size_t c) { return loadStrided(label + c, count, 4, kUnorm16); };
      const V alpha = channel(3), left = all(1.0f) - alpha;
      l = {meniscus::tiles::HWY_NAMESPACE::add({channel(0), channel(1), channel(2)}, scale(l.color, left)),
           alpha + left * l.alpha};
    }
    const auto store = [&](V value, float* to) {
      if (add) value = value + loadSome(f, to + column, count);
      storeSome(f, value, count, to + column);
    };
    store(l.color.x, out.red);
    store(l.color.y, out.green);
    store(l.color.z, out.blue);
    store(l.alpha, out.alpha);
  }
}

// include/color.glsl, of 0..1; within 6e-7. Above the straight part 1.055 c^(5/12) - 0.055 is a polynomial in
// c^(1/4), by interpolation in Chebyshev's nodes.
HWY_INLINE V srgbFromLinear(V c) {
  const V t = hn::Sqrt(hn::Sqrt(c));
  V curve = all(-0.0679922625f);
  for (const float term :
       {0.358946383f, -0.833786547f, 1.14651501f, -1.12084925f, 1.45024204f, 0.125506088f, -0.0585816801f})
    curve = curve * t + all(term);
  return hn::IfThenElse(c > all(0.0031308f), curve, c * all(12.92f));
}

// pictureValue() of include/picture.glsl, as it is stored.
void encodeRow(const EncodeTask& task, const LitRow& row, std::size_t count, std::byte* out) {
  const F f;
  const U u;
  const V zero = hn::Zero(f), one = all(1.0f), per = all(task.perSample);
  const std::size_t lanes = laneCount();
  const float most = task.format == PixelFormat::rgba8 ? 255.0f : 65535.0f;
  const std::size_t pixelBytes = bytesPerPixel(task.format);
  for (std::size_t x = 0; x < count; x += lanes) {
    const std::size_t here = std::min(lanes, count - x);
    const auto load = [&](const float* from) { return loadSome(f, from + x, here) * per; };
    const Vec3 color{load(row.red), load(row.green), load(row.blue)};
    const V a = load(row.alpha), left = one - a;
    if (task.nothing != nullptr &&
        hn::AllTrue(f, hn::Max(hn::Max(color.x, color.y), hn::Max(color.z, a)) <= zero)) {
      std::memcpy(out + pixelBytes * x, task.nothing, pixelBytes * here);
      continue;
    }
    const V alpha = a + left * all(task.backdrop.w);
    const Vec3 over = add(color, scale(xyz(task.backdrop), left));
    if (task.format == PixelFormat::rgbaFloat) {
      alignas(64) float values[4][kMostLanes];
      hn::Store(over.x, f, values[0]);
      hn::Store(over.y, f, values[1]);
      hn::Store(over.z, f, values[2]);
      hn::Store(alpha, f, values[3]);
      for (std::size_t k = 0; k < here; ++k) {
        const float pixel[4] = {values[0][k], values[1][k], values[2][k], values[3][k]};
        std::memcpy(out + sizeof(pixel) * (x + k), pixel, sizeof(pixel));
      }
      continue;
    }
    const auto stored = [&](V share) {  // not above 1 but for rounding
      return hn::BitCast(u, nearestWhole(hn::Min(share, one) * all(most)));
    };
    const auto channel = [&](V straight) {
      return stored(srgbFromLinear(hn::Min(hn::Max(straight, zero), one)));
    };
    Vec3 straight = over;
    if (!hn::AllTrue(f, alpha == one)) {
      const M some = alpha > zero;
      const V divisor = hn::IfThenElse(some, alpha, one);
      straight = choose(some, {over.x / divisor, over.y / divisor, over.z / divisor}, {zero, zero, zero});
    }
    const auto red = channel(straight.x), green = channel(straight.y), blue = channel(straight.z),
               opaque = stored(alpha);
    alignas(64) std::uint32_t pixels[2 * kMostLanes];
    if (task.format == PixelFormat::rgba8) {
      hn::Store(hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)),
                       hn::Or(hn::ShiftLeft<16>(blue), hn::ShiftLeft<24>(opaque))),
                u, pixels);
      std::memcpy(out + 4 * x, pixels, 4 * here);
    } else {
      hn::StoreInterleaved2(hn::Or(red, hn::ShiftLeft<16>(green)), hn::Or(blue, hn::ShiftLeft<16>(opaque)), u,
                            pixels);
      std::memcpy(out + 8 * x, pixels, 8 * here);
    }
  }
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(shadeRow);
HWY_EXPORT(encodeRow);

namespace {

// A highlight is nothing where the squared cosine of its angle is no larger: less than 1e-8 of its light by
// x^p <= exp(-2 p (1 - x) / (1 + x)), or seen along the surface.
float leastSquare(float shininess) {
  const float bound = 18.5f / (0.5f * shininess);
  return std::max(1e-12f, (2 - bound) / (2 + bound));  // the former, too, if shininess is 0
}

ShadeTask taskOf(const SurfacePlanes& planes, const ShadeBlock& block, const LightPlanes& light) {
  return {&planes,
          &block,
          &light,
          Nearness(planes.view),
          leastSquare(block.ambient.z),
          1 / std::max(0.1f * block.key.w, 1e-30f)};
}

// Encodes the part of a row that is the picture's; what is not lit is backdrop.
class RowWriter {
 public:
  // litX, litWidth: of the target, where there may be light.
  RowWriter(const PictureRows& out, int samples, const glm::vec4& backdrop, int litX, int litWidth)
      : out_(out),
        task_{1 / static_cast<float>(samples), backdrop, out.format, nullptr},
        pixelBytes_(bytesPerPixel(out.format)),
        first_(std::clamp(litX, out.x, out.x + out.width)),
        end_(std::clamp(litX + litWidth, first_, out.x + out.width)),
        litX_(litX),
        empty_(pixelBytes_ * static_cast<std::size_t>(out.width)) {
    std::vector<float> nothing(static_cast<std::size_t>(out.width), 0.0f);
    const float* const zeros = nothing.data();
    HWY_DYNAMIC_DISPATCH(encodeRow)
    (task_, LitRow{zeros, zeros, zeros, zeros}, nothing.size(), empty_.data());
    task_.nothing = empty_.data();
  }
  // y: of the target.
  void writeBackdrop(int y) const { std::memcpy(rowOf(y), empty_.data(), empty_.size()); }
  // light: from litX on.
  void write(int y, const LitRow& light) const {
    std::byte* const row = rowOf(y);
    const auto bytes = [&](int pixels) { return pixelBytes_ * static_cast<std::size_t>(pixels); };
    std::memcpy(row, empty_.data(), bytes(first_ - out_.x));
    const int skipped = first_ - litX_;
    HWY_DYNAMIC_DISPATCH(encodeRow)
    (task_, LitRow{light.red + skipped, light.green + skipped, light.blue + skipped, light.alpha + skipped},
     static_cast<std::size_t>(end_ - first_), row + bytes(first_ - out_.x));
    std::memcpy(row + bytes(end_ - out_.x), empty_.data(), bytes(out_.x + out_.width - end_));
  }

 private:
  std::byte* rowOf(int y) const { return out_.first + out_.rowBytes * static_cast<std::size_t>(y - out_.y); }

  const PictureRows& out_;
  EncodeTask task_;
  std::size_t pixelBytes_;
  int first_, end_, litX_;
  std::vector<std::byte> empty_;  // a row of backdrop
};

}  // namespace

void addLight(const SurfacePlanes& planes, const ShadeBlock& block, const LightPlanes& light, bool first,
              LightSum& sum) {
  if (first) {
    sum.x = planes.x;
    sum.y = planes.y;
    sum.width = planes.width;
    sum.height = planes.height;
    for (std::vector<float>* channel : {&sum.red, &sum.green, &sum.blue, &sum.alpha})
      channel->resize(sum.pixels());
  }
  MENISCUS_CHECK(sum.x == planes.x && sum.y == planes.y && sum.width == planes.width &&
                 sum.height == planes.height);
  const ShadeTask task = taskOf(planes, block, light);
  forRows(planes.height, [&](int y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(sum.width);
    HWY_DYNAMIC_DISPATCH(shadeRow)
    (task, y, !first,
     LightRow{sum.red.data() + row, sum.green.data() + row, sum.blue.data() + row, sum.alpha.data() + row});
  });
}

void writePicture(const LightSum& sum, int samples, const glm::vec4& backdrop, const PictureRows& out) {
  const RowWriter writer(out, samples, backdrop, sum.x, sum.width);
  forRows(out.height, [&](int row) {
    const int y = out.y + row;
    if (y < sum.y || y >= sum.y + sum.height) {
      writer.writeBackdrop(y);
      return;
    }
    const std::size_t at = static_cast<std::size_t>(y - sum.y) * static_cast<std::size_t>(sum.width);
    writer.write(y,
                 {sum.red.data() + at, sum.green.data() + at, sum.blue.data() + at, sum.alpha.data() + at});
  });
}

void shadePicture(const SurfacePlanes& planes, const ShadeBlock& block, const LightPlanes& light,
                  const PictureRows& out) {
  const ShadeTask task = taskOf(planes, block, light);
  const RowWriter writer(out, 1, block.backdrop, planes.x, planes.width);
  forRows(out.height, [&](int row) {
    const int y = out.y + row - planes.y;
    if (y < 0 || y >= planes.height) {
      writer.writeBackdrop(out.y + row);
      return;
    }
    thread_local std::vector<float> light4;
    const auto width = static_cast<std::size_t>(planes.width);
    light4.resize(4 * width);
    const LightRow lightRow{light4.data(), light4.data() + width, light4.data() + 2 * width,
                            light4.data() + 3 * width};
    HWY_DYNAMIC_DISPATCH(shadeRow)(task, y, false, lightRow);
    writer.write(out.y + row, {lightRow.red, lightRow.green, lightRow.blue, lightRow.alpha});
  });
}

}  // namespace meniscus::effects
#endif

#include "app/measure/error_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <vector>

#include "io/image_writer.h"

namespace meniscus::measure {

namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr int kMostWidth = 480;  // of each half
constexpr std::uint32_t kNothing = 0x101418, kGrazing = 0x5A6068, kMissed = 0xFF2D2D, kFalse = 0xFF3DF2;
// Samples of "viridis" (Smith, van der Walt 2015, CC0): as light as the error is large.
constexpr std::uint32_t kScale[] = {0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C,
                                    0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};
constexpr double kLowest = -8;  // powers of ten [Å], a step each

Color split(std::uint32_t c) {
  return {static_cast<std::uint8_t>(c >> 16), static_cast<std::uint8_t>(c >> 8 & 0xFF),
          static_cast<std::uint8_t>(c & 0xFF)};
}

// The larger, the worse.
struct Wrong {
  int rank = 0;
  double error = 0;
  bool operator<(const Wrong& other) const {
    return rank != other.rank ? rank < other.rank : error < other.error;
  }
};

Wrong wrongAt(const HitImage& image, const ReferenceImage& truth, std::size_t i) {
  const double t = static_cast<double>(image.distance[i]), t0 = truth.distance[i];
  const bool hit = t != std::numeric_limits<double>::infinity(), hit0 = std::isfinite(t0);
  if (truth.grazing[i] != 0) return {1, 0};
  if (hit && hit0) return {2, std::isfinite(t) ? std::abs(t - t0) : 1e9};
  return {!hit && !hit0 ? 0 : hit ? 3 : 4, 0};
}

Color colorOf(const Wrong& wrong) {
  constexpr std::uint32_t kPlain[] = {kNothing, kGrazing, 0, kFalse, kMissed};
  if (wrong.rank != 2) return split(kPlain[wrong.rank]);
  const double last = static_cast<double>(std::size(kScale)) - 1;
  const double place = std::clamp(std::log10(std::max(wrong.error, 1e-30)) - kLowest, 0.0, last);
  const auto low = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  const Color a = split(kScale[low]), b = split(kScale[low + 1]);
  Color out;
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(
        std::lround(a[c] + (place - static_cast<double>(low)) * (double(b[c]) - double(a[c]))));
  return out;
}

std::unordered_map<std::uint32_t, std::uint32_t> colorsOf(const Primitives& primitives) {
  std::unordered_map<std::uint32_t, std::uint32_t> colors;
  for (const MetaballField& field : primitives.surfaces)
    for (const Metaball& ball : field.balls) colors[ball.id] = ball.color;
  for (const SpherePrimitive& s : primitives.spheres) colors[s.id] = s.color;
  for (const EllipsoidPrimitive& e : primitives.ellipsoids) colors[e.id] = e.color;
  for (const CylinderPrimitive& c : primitives.cylinders) {
    colors.try_emplace(c.idA, c.colorA);
    colors.try_emplace(c.idB, c.colorB);
  }
  return colors;
}

// As if lit from the eye: 0 to 255.
glm::dvec3 shadedAt(const HitImage& image, const std::unordered_map<std::uint32_t, std::uint32_t>& colors,
                    std::size_t at) {
  const auto found = colors.find(image.id[at]);
  if (image.id[at] == 0 || found == colors.end()) return glm::dvec3(255.0);
  const Color color = split(found->second);
  const double facing = static_cast<double>(image.normal[at].z);
  const double light = std::isfinite(facing) ? 0.25 + 0.75 * std::clamp(facing, 0.0, 1.0) : 0;
  return light * glm::dvec3(color[0], color[1], color[2]);
}

/// Rows from the top, four bytes a pixel.
void writePng(const std::filesystem::path& path, ImageSize size, const std::vector<std::byte>& pixels) {
  ImageFileOptions options;
  options.size = size;
  const auto file = ImageFile::create(path, options);
  file->writeRows(pixels);
  file->finish();
}

}  // namespace

void writeErrorPicture(const std::filesystem::path& path, const HitImage& image, const ReferenceImage& truth,
                       const Primitives& primitives) {
  const int step = (image.size.width + kMostWidth - 1) / kMostWidth;
  const int width = (image.size.width + step - 1) / step, height = (image.size.height + step - 1) / step;
  const auto colors = colorsOf(primitives);
  const ImageSize size{2 * width, height};
  std::vector<std::byte> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(height) * 4,
                                std::byte{255});
  const auto store = [&](int x, int y, const Color& color) {
    const auto at = 4 * (static_cast<std::size_t>(height - 1 - y) * static_cast<std::size_t>(size.width) +
                         static_cast<std::size_t>(x));
    for (std::size_t c = 0; c < 3; ++c) pixels[at + c] = std::byte{color[c]};
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Wrong worst;
      glm::dvec3 sum(0.0);
      int count = 0;
      for (int j = y * step; j < std::min((y + 1) * step, image.size.height); ++j) {
        for (int i = x * step; i < std::min((x + 1) * step, image.size.width); ++i) {
          const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(image.size.width) +
                          static_cast<std::size_t>(i);
          const Wrong wrong = wrongAt(image, truth, at);
          if (worst < wrong) worst = wrong;
          ++count;
          sum += shadedAt(image, colors, at);
        }
      }
      const glm::dvec3 mean = sum / static_cast<double>(std::max(count, 1));
      store(x, y,
            {static_cast<std::uint8_t>(mean.x), static_cast<std::uint8_t>(mean.y),
             static_cast<std::uint8_t>(mean.z)});
      store(width + x, y, colorOf(worst));
    }
  }
  writePng(path, size, pixels);
}

void writeShaded(const std::filesystem::path& path, const HitImage& image, const Primitives& primitives) {
  const auto colors = colorsOf(primitives);
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<std::byte> pixels(image.id.size() * 4, std::byte{255});
  for (std::size_t i = 0; i < image.id.size(); ++i) {
    const std::size_t row = static_cast<std::size_t>(image.size.height) - 1 - i / width;
    const glm::dvec3 color = shadedAt(image, colors, i);
    for (int c = 0; c < 3; ++c)
      pixels[4 * (row * width + i % width) + static_cast<std::size_t>(c)] =
          static_cast<std::byte>(std::lround(color[c]));
  }
  writePng(path, image.size, pixels);
}

void writeGrazing(const std::filesystem::path& path, const ReferenceImage& truth) {
  const ImageSize size = truth.hits.size;
  std::vector<std::byte> pixels(truth.grazing.size() * 4, std::byte{255});
  const auto width = static_cast<std::size_t>(size.width);
  for (std::size_t i = 0; i < truth.grazing.size(); ++i) {
    const std::size_t row = static_cast<std::size_t>(size.height) - 1 - i / width;
    for (std::size_t c = 0; c < 3; ++c)
      pixels[4 * (row * width + i % width) + c] = truth.grazing[i] != 0 ? std::byte{255} : std::byte{0};
  }
  writePng(path, size, pixels);
}

void writeLayers(const std::filesystem::path& path, const HitImage& image) {
  ImageFileOptions options;
  options.size = image.size;
  options.format = PixelFormat::rgbaFloat;
  options.layers.color = false;
  options.layers.normal = options.layers.distance = options.layers.id = true;
  const auto file = ImageFile::create(path, options);
  struct Pixel {
    float normal[3], distance;
    std::uint32_t id;
  };
  static_assert(sizeof(Pixel) == 20);
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<Pixel> row(width);
  for (int y = image.size.height; y-- > 0;) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * width + x;
      const glm::vec3& n = image.normal[at];
      row[x] = {{n.x, n.y, n.z}, image.distance[at], image.id[at]};
    }
    file->writeRows(std::as_bytes(std::span(row)));
  }
  file->finish();
}

std::vector<LegendEntry> errorLegend() {
  std::vector<LegendEntry> legend = {{kMissed, "missed: the truth has a hit"},
                                     {kFalse, "false: the truth has none"},
                                     {kGrazing, "grazing: not judged"},
                                     {kNothing, "nothing, rightly"}};
  constexpr const char* kDecades[] = {"1e-8 Å or less", "1e-7 Å", "1e-6 Å", "1e-5 Å",     "1e-4 Å",
                                      "1e-3 Å",         "0.01 Å", "0.1 Å",  "1 Å or more"};
  for (std::size_t i = 0; i < std::size(kScale); ++i) legend.push_back({kScale[i], kDecades[i]});
  return legend;
}

}  // namespace meniscus::measure

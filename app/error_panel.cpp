#include "app/error_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/label_text.h"

namespace meniscus {
namespace {

constexpr std::array<Rgb, 9> kViridis{0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C,
                                      0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};

double channel(Rgb color, int shift) {
  return (color >> shift) & 0xFFu;
}

// Of a share 0..1 of the scale.
Rgb colorOf(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  Rgb color = 0;
  for (const int shift : {16, 8, 0}) {
    const double mixed = std::lerp(channel(kViridis[first], shift), channel(kViridis[first + 1], shift),
                                   at - static_cast<double>(first));
    color |= static_cast<Rgb>(std::lround(mixed)) << shift;
  }
  return color;
}

void write(Rgb color, bool opaque, std::byte* pixel) {
  for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::byte>(color >> (16 - 8 * i) & 0xFFu);
  pixel[3] = opaque ? std::byte{0xFF} : std::byte{0};
}

// Below the label, a line each, in letters that let the longest fit.
void writeSummary(const ErrorPicture& errors, const RenderOptions& options, const PanelPlace& place,
                  PanelCanvas& canvas) {
  const double label = 0.01 * options.labelSize * options.size.height;
  std::vector<Label> lines;
  for (const std::string& line : errors.summary()) lines.push_back({line, {}, 0});
  const auto drawn = [&](double letters) {
    return drawLabels(lines, std::max(letters, 1.0), options.labelFont);
  };
  const int margin = labelMargin(place);
  std::vector<LabelSprite> sprites = drawn(0.7 * label);
  int widest = 1;
  for (const LabelSprite& sprite : sprites) widest = std::max(widest, sprite.width);
  if (widest > place.width - 2 * margin) sprites = drawn(0.7 * label * (place.width - 2 * margin) / widest);
  int top = margin + static_cast<int>(std::lround(1.3 * label));
  for (const LabelSprite& sprite : sprites) {
    canvas.write(place, sprite, options.labelColors, margin, top);
    top += sprite.height;
  }
}

// What the colours of an error panel mean, along its lower edge.
void drawScale(const RenderOptions& options, const PanelPlace& place, PanelCanvas& canvas) {
  const double letters = std::max(0.007 * options.labelSize * options.size.height, 1.0);
  const std::vector<LabelSprite> ends =
      drawLabels({{fmt::format("{:g} Å", kLeastError), {}, 0}, {fmt::format("{:g} Å", kMostError), {}, 0}},
                 letters, options.labelFont);
  const int height = std::max(static_cast<int>(std::lround(letters)), 1);
  int left = height, right = place.width - height;
  const int top = place.height - 2 * height;
  const auto middle = [&](const LabelSprite& end) { return top + (height - end.height) / 2; };
  canvas.write(place, ends[0], options.labelColors, left, middle(ends[0]));
  canvas.write(place, ends[1], options.labelColors, right - ends[1].width, middle(ends[1]));
  left += ends[0].width + height / 2;
  right -= ends[1].width + height / 2;
  if (right > left)
    canvas.paste(place, drawErrorScale(right - left, height), right - left, height, left, top);
}

}  // namespace

Rgb errorColor(double distance) {
  if (!(distance > kLeastError)) return kViridis.front();
  return colorOf(std::log(distance / kLeastError) / std::log(kMostError / kLeastError));
}

std::vector<std::string> ErrorPicture::summary() const {
  return {fmt::format("largest {:.2g} Å", largest), fmt::format("99 % at most {:.2g} Å", distanceP99),
          fmt::format("pixels missed: {}", missed), fmt::format("pixels too many: {}", falseHits)};
}

ErrorPicture drawErrors(const HitImage& picture, const HitImage& truth, const Background& background) {
  const auto width = static_cast<std::size_t>(truth.size.width),
             height = static_cast<std::size_t>(truth.size.height);
  ErrorPicture made;
  made.pixels.resize(4 * width * height);
  std::vector<double> distances;
  for (std::size_t row = 0; row < height; ++row) {
    std::byte* pixel = made.pixels.data() + 4 * width * (height - 1 - row);
    for (std::size_t i = row * width; i < (row + 1) * width; ++i, pixel += 4) {
      const double at = picture.distance[i], right = truth.distance[i];
      const bool hit = std::isfinite(at), due = std::isfinite(right);
      if (hit && due) {
        distances.push_back(std::abs(at - right));
        write(errorColor(distances.back()), true, pixel);
      } else if (hit || due) {
        ++(due ? made.missed : made.falseHits);
        write(due ? kMissedColor : kFalseColor, true, pixel);
      } else {
        write(background.color, !background.transparent, pixel);
      }
    }
  }
  if (distances.empty()) return made;
  const auto at99 = static_cast<std::size_t>(0.99 * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(at99), distances.end());
  made.distanceP99 = distances[at99];
  made.largest = *std::max_element(distances.begin(), distances.end());
  return made;
}

std::vector<std::byte> drawErrorScale(int width, int height) {
  std::vector<std::byte> pixels(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
    const auto x = static_cast<double>(i % static_cast<std::size_t>(width));
    write(colorOf(x / std::max(width - 1, 1)), true, pixels.data() + 4 * i);
  }
  return pixels;
}

void drawErrorPanel(const ErrorPicture& errors, const RenderOptions& options, const PanelPlace& place,
                    PanelCanvas& canvas) {
  canvas.paste(place, errors.pixels);
  writeSummary(errors, options, place, canvas);
  drawScale(options, place, canvas);
}

}  // namespace meniscus

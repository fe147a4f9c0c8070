#include "app/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "app/option_values.h"
#include "app/render_options.h"
#include "app/style.h"
#include "core/error.h"

namespace meniscus {
namespace {

constexpr int kLine = 2;               // between panels [pixels]
constexpr std::byte kLineGrey{0x80};   // seen on any background
constexpr double kLabelMargin = 0.01;  // of the panel's height

// What is the whole picture's and no panel's.
constexpr std::array<std::string_view, 13> kShared{"size",     "panel",  "divider", "depth", "channels",
                                                   "dpi",      "orient", "rotate",  "focus", "target",
                                                   "distance", "near",   "far"};

// The style's options in place of its name: those of the whole picture are no match for a panel's.
std::vector<std::string> withStyleAlone(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = withStyle(arguments);
  for (auto word = words.begin(); word != words.end();) {
    const bool apart = *word == "--style" && word + 1 != words.end();
    if (apart || word->starts_with("--style="))
      word = words.erase(word, word + (apart ? 2 : 1));
    else
      ++word;
  }
  return words;
}

// `count` parts of a length with lines between them, as equal as whole pixels can be.
std::pair<int, int> part(int length, int count, int index) {
  const int free = std::max(length - kLine * (count - 1), count);
  const int from = static_cast<int>(static_cast<long long>(free) * index / count) + kLine * index;
  const int to = static_cast<int>(static_cast<long long>(free) * (index + 1) / count) + kLine * index;
  return {std::min(from, length - 1), std::max(1, std::min(to, length) - std::min(from, length - 1))};
}

}  // namespace

PanelOptions parsePanel(std::string_view option, std::string_view value) {
  PanelOptions panel;
  std::string text(value);
  const std::size_t colon = text.find(": ");
  if (colon != std::string::npos && colon < text.find("--")) {
    panel.label = text.substr(0, colon);
    text.erase(0, colon + 2);
  }
  std::istringstream words(text);
  for (std::string word; words >> word;) panel.arguments.push_back(word);
  if (panel.arguments == std::vector<std::string>{"error"}) {
    panel.error = true;
    panel.arguments.clear();
    if (panel.label.empty()) panel.label = "error";
    return panel;
  }
  if (panel.arguments.size() == 1 && !panel.arguments.front().starts_with("-")) {
    const Representation representation = parseRepresentation(option, panel.arguments.front());
    if (panel.label.empty()) panel.label = panel.arguments.front();
    panel.arguments = {"--representation", std::string(representationName(representation))};
  }
  if (panel.arguments.empty())
    throwBadValue(
        option, value,
        "a representation, options as in 'skin: --representation surface --opacity 0.5', or 'error'");
  try {
    panel.arguments = withStyleAlone(panel.arguments);
    const RenderOptions parsed = parseSettings(panel.arguments);
    if (!parsed.files.empty()) throw UsageError("files are the whole picture's");
    for (const auto& [name, given] : parsed.given)
      if (std::find(kShared.begin(), kShared.end(), name) != kShared.end())
        throw UsageError(fmt::format("--{} is the whole picture's", name));
    if (!parsed.ofTheRun.empty())
      throw UsageError(fmt::format("--{} is the whole picture's", parsed.ofTheRun.front()));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: '{}': {}", option, value, error.what()));
  }
  return panel;
}

std::vector<PanelPlace> placePanels(std::size_t count, ImageSize whole, std::optional<double> divider) {
  std::vector<PanelPlace> places;
  if (divider && count == 2) {
    const int left = std::clamp(static_cast<int>(std::lround(*divider * whole.width)), 0, whole.width);
    const int line = std::min(kLine, whole.width - left);
    places.push_back({0, 0, left, whole.height, whole, 0, 0});
    places.push_back({left + line, 0, whole.width - left - line, whole.height, whole, 0, 0});
    return places;
  }
  const bool wide = whole.width >= whole.height;
  const int n = static_cast<int>(count);
  const int columns = n == 4 ? 2 : wide ? n : 1, rows = n == 4 ? 2 : wide ? 1 : n;
  for (int i = 0; i < n; ++i) {
    const auto [x, width] = part(whole.width, columns, i % columns);
    const auto [y, height] = part(whole.height, rows, i / columns);
    places.push_back({x, y, width, height, {width, height}, x, y});
  }
  return places;
}

int labelMargin(const PanelPlace& place) {
  return static_cast<int>(std::lround(kLabelMargin * place.height));
}

Camera seenBy(const Camera& viewpoint, Camera lens) {
  lens.orientation = viewpoint.orientation;
  lens.target = viewpoint.target;
  lens.distance = viewpoint.distance;
  lens.nearest = viewpoint.nearest;
  lens.farthest = viewpoint.farthest;
  return lens;
}

PanelCanvas::PanelCanvas(ImageSize size)
    : size_(size),
      bytes_(std::size_t{4} * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
             kLineGrey) {
  for (std::size_t i = 3; i < bytes_.size(); i += 4) bytes_[i] = std::byte{0xFF};
}

std::byte* PanelCanvas::at(int x, int y) {
  return bytes_.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                              static_cast<std::size_t>(x));
}

void PanelCanvas::paste(const PanelPlace& place, std::span<const std::byte> picture) {
  if (place.width <= 0) return;
  for (int y = place.y; y < place.y + place.height; ++y) {
    const std::size_t row =
        static_cast<std::size_t>(y - place.pictureY) * static_cast<std::size_t>(place.picture.width);
    const std::size_t first = 4 * (row + static_cast<std::size_t>(place.x - place.pictureX));
    std::memcpy(at(place.x, y), picture.data() + first,
                std::size_t{4} * static_cast<std::size_t>(place.width));
  }
}

void PanelCanvas::paste(const PanelPlace& place, std::span<const std::byte> picture, int width, int height,
                        int left, int top) {
  for (int y = std::max(-top, 0); y < std::min(height, place.height - top); ++y)
    for (int x = std::max(-left, 0); x < std::min(width, place.width - left); ++x)
      std::memcpy(at(place.x + left + x, place.y + top + y),
                  picture.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(x)),
                  4);
}

void PanelCanvas::write(const PanelPlace& place, const LabelSprite& label, const LabelColors& colors) {
  const int margin = labelMargin(place);
  write(place, label, colors, margin, margin);
}

void PanelCanvas::write(const PanelPlace& place, const LabelSprite& label, const LabelColors& colors,
                        int left, int top) {
  const auto blend = [](std::byte* pixel, Rgb color, std::uint8_t cover) {
    const auto mix = [&](int i, unsigned to) {
      const unsigned from = std::to_integer<unsigned>(pixel[i]);
      pixel[i] = static_cast<std::byte>((from * (255u - cover) + to * cover + 127) / 255);
    };
    mix(0, (color >> 16) & 0xFFu);
    mix(1, (color >> 8) & 0xFFu);
    mix(2, color & 0xFFu);
    mix(3, 255);
  };
  for (int y = std::max(-top, 0); y < std::min(label.height, place.height - top); ++y) {
    for (int x = std::max(-left, 0); x < std::min(label.width, place.width - left); ++x) {
      const LabelTexel& texel =
          label.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(label.width) +
                       static_cast<std::size_t>(x)];
      std::byte* pixel = at(place.x + left + x, place.y + top + y);
      blend(pixel, colors.seam, texel.seam);
      blend(pixel, colors.text, texel.text);
    }
  }
}

}  // namespace meniscus

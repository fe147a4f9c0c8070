#include "app/measure/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace meniscus::measure {

namespace {

constexpr double kWidth = 548, kHeight = 372, kLeft = 66, kRight = 24, kTop = 34, kBottom = 46;

// Tableau 10 without its grey: told apart on white, and by most who see colours differently.
constexpr const char* kColors[] = {"#4e79a7", "#e15759", "#59a14f", "#f28e2b", "#b07aa1",
                                   "#76b7b2", "#9c755f", "#d4a017", "#ff9da7", "#3b3b98"};
constexpr const char* kMarkers[] = {"circle", "square", "diamond", "triangle"};

/// A logarithmic axis from one decade to another.
struct Axis {
  double low = 0, high = 1;  // powers of ten
  double from = 0, to = 1;   // in the drawing

  void fit(double least, double most) {
    low = std::floor(std::log10(least) * 2 + 1e-9) / 2;
    high = std::ceil(std::log10(most) * 2 - 1e-9) / 2;
    if (high - low < 0.9) high = low + 1;
  }
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

std::string powerText(int power) {
  if (power >= -2 && power <= 4) return fmt::format("{}", std::pow(10.0, power));
  return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", power);
}

std::string marker(const std::string& shape, double x, double y, double r, const std::string& style) {
  if (shape == "square")
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>", x - r,
                       y - r, 2 * r, 2 * r, style);
  if (shape == "diamond")
    return fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}z\" {}/>", x,
                       y - 1.3 * r, 1.3 * r, 1.3 * r, -1.3 * r, 1.3 * r, -1.3 * r, -1.3 * r, style);
  if (shape == "triangle")
    return fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z\" {}/>", x, y - 1.2 * r, 1.2 * r,
                       2.1 * r, -2.4 * r, style);
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>", x, y, r, style);
}

class Drawing {
 public:
  Drawing(const Plot& plot, const std::vector<std::size_t>& colors) : plot_(plot), colors_(colors) {}
  std::string svg();
  std::string file();

 private:
  bool shown(const PlotPoint& p) const {
    return std::isfinite(p.x) && p.x > 0 && std::isfinite(p.y) && (p.y > 0 || plot_.yFloor > 0);
  }
  double yOf(const PlotPoint& p) const { return std::max(p.y, plot_.yFloor); }
  bool fit();
  void grid();
  void series(const PlotSeries& s, std::size_t color);
  void front();
  void legend();

  const Plot& plot_;
  const std::vector<std::size_t>& colors_;
  Axis x_, y_;
  std::string out_;
  bool links_ = true;
};

bool Drawing::fit() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lowX = kInfinity, highX = 0, lowY = kInfinity, highY = 0;
  for (const PlotSeries& s : plot_.series) {
    for (const PlotPoint& p : s.points) {
      if (!shown(p)) continue;
      lowX = std::min(lowX, p.x);
      highX = std::max(highX, p.x);
      lowY = std::min(lowY, yOf(p));
      highY = std::max(highY, yOf(p));
    }
  }
  if (highX == 0) return false;
  x_.fit(lowX * 0.9, highX * 1.1);
  y_.fit(lowY * 0.8, std::max(highY * 1.25, plot_.yFloor * 100));
  x_.from = kLeft;
  x_.to = kWidth - kRight;
  y_.from = kHeight - kBottom;
  y_.to = kTop;
  return true;
}

void Drawing::grid() {
  const auto line = [&](double x1, double y1, double x2, double y2, const char* kind) {
    out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>", x1,
                        y1, x2, y2, kind);
  };
  const bool narrowX = x_.high - x_.low < 2, narrowY = y_.high - y_.low < 2;
  for (int power = static_cast<int>(std::floor(x_.low)); power <= x_.high; ++power) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, power), at = x_.at(value);
      if (at < x_.from - 0.5 || at > x_.to + 0.5) continue;
      line(at, y_.from, at, y_.to, digit == 1 ? "major" : "minor");
      const bool labelled = digit == 1 || (narrowX && (digit == 2 || digit == 5));
      if (labelled)
        out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at,
                            y_.from + 16, digit == 1 ? powerText(power) : fmt::format("{:g}", value));
    }
  }
  const double span = y_.high - y_.low;
  const int every = span > 8 ? 2 : 1;
  for (int power = static_cast<int>(std::floor(y_.low)); power <= y_.high; ++power) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, power), at = y_.at(value);
      if (at > y_.from + 0.5 || at < y_.to - 0.5 || (digit > 1 && span > 4)) continue;
      line(x_.from, at, x_.to, at, digit == 1 ? "major" : "minor");
      const bool labelled = (digit == 1 && power % every == 0) || (narrowY && (digit == 2 || digit == 5));
      if (labelled)
        out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", x_.from - 6,
                            at + 4, digit == 1 ? powerText(power) : fmt::format("{:g}", value));
    }
  }
  if (plot_.yFloor > 0 && y_.low <= std::log10(plot_.yFloor)) {
    const double at = y_.at(plot_.yFloor);
    line(x_.from, at, x_.to, at, "floor");
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" class=\"note\">{}</text>",
                        x_.to - 4, at - 5, escaped(plot_.floorLabel));
  }
  out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>", x_.from, y_.to,
                      x_.to - x_.from, y_.from - y_.to);
  out_ += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" class=\"label\">{}</text>",
                      (x_.from + x_.to) / 2, kHeight - 8, escaped(plot_.xLabel));
  out_ += fmt::format(
      "<text transform=\"translate(15 {:.1f}) rotate(-90)\" text-anchor=\"middle\" class=\"label\">{}</text>",
      (y_.from + y_.to) / 2, escaped(plot_.yLabel));
  out_ += fmt::format("<text x=\"{}\" y=\"20\" class=\"title\">{}</text>", kLeft, escaped(plot_.title));
}

// A staircase through what nothing beats.
void Drawing::front() {
  std::vector<std::pair<double, double>> points;
  for (const PlotSeries& s : plot_.series)
    for (const PlotPoint& p : s.points)
      if (p.front && shown(p)) points.emplace_back(x_.at(p.x), y_.at(yOf(p)));
  if (points.empty()) return;
  std::sort(points.begin(), points.end());
  std::string path = fmt::format("M{:.1f} {:.1f}", points.front().first, y_.to);
  for (const auto& [x, y] : points) path += fmt::format("H{:.1f}V{:.1f}", x, y);
  out_ += fmt::format("<path d=\"{}H{:.1f}\" class=\"front\"/>", path, x_.to);
}

void Drawing::series(const PlotSeries& s, std::size_t color) {
  const char* stroke = seriesColor(color);
  std::string path;
  for (const PlotPoint& p : s.points)
    if (shown(p)) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_.at(p.x), y_.at(yOf(p)));
  out_ += fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-linejoin=\"round\"/>", path,
      stroke);
  for (const PlotPoint& p : s.points) {
    if (!shown(p)) continue;
    const double x = x_.at(p.x), y = y_.at(yOf(p));
    const std::string style =
        fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"", p.front ? stroke : "#fff", stroke, 1.8);
    const std::string mark = marker(kMarkers[color % std::size(kMarkers)], x, y, 4.2, style);
    out_ += links_ ? fmt::format("<a href=\"{}\"><title>{}</title>{}</a>", escaped(p.link), escaped(p.title),
                                 mark)
                   : mark;
  }
}

std::string Drawing::svg() {
  if (!fit()) return "";
  out_ = fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{}\">",
                     kWidth, kHeight, kWidth, kHeight, escaped(plot_.title));
  grid();
  if (plot_.joinFront) front();
  for (std::size_t i = 0; i < plot_.series.size(); ++i) series(plot_.series[i], colors_[i]);
  return out_ + "</svg>";
}

void Drawing::legend() {
  double y = y_.to + 18;
  for (std::size_t i = 0; i < plot_.series.size(); ++i, y += 18) {
    out_ += marker(kMarkers[colors_[i] % std::size(kMarkers)], x_.to - 12, y - 4, 4.2,
                   fmt::format("fill=\"{0}\" stroke=\"{0}\"", seriesColor(colors_[i])));
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" class=\"label\">{}</text>",
                        x_.to - 22, y, escaped(plot_.series[i].name));
  }
}

// Links lead nowhere outside of the page.
std::string Drawing::file() {
  constexpr const char* kStyle =
      "text{font-family:system-ui,'DejaVu Sans',sans-serif;font-size:11px;fill:#5d6b7a}"
      ".title{font-size:13px;font-weight:600;fill:#1c2530}.label{font-size:12px;fill:#1c2530}"
      ".note{font-style:italic}.major{stroke:#d5dce3}.minor{stroke:#eef1f4}.frame{fill:none;stroke:#9aa7b3}"
      ".floor{stroke:#9aa7b3;stroke-dasharray:5 4}"
      ".front{fill:none;stroke:#1c2530;stroke-width:1.1;stroke-dasharray:2 3;opacity:.65}";
  if (!fit()) return "";
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">"
      "<style>{2}</style><rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      kWidth, kHeight, kStyle);
  links_ = false;
  grid();
  if (plot_.joinFront) front();
  for (std::size_t i = 0; i < plot_.series.size(); ++i) series(plot_.series[i], colors_[i]);
  legend();
  return out_ + "</svg>\n";
}

}  // namespace

std::string svgFileOf(const Plot& plot, const std::vector<std::size_t>& colors) {
  return Drawing(plot, colors).file();
}

std::string svgOf(const Plot& plot, const std::vector<std::size_t>& colors) {
  return Drawing(plot, colors).svg();
}

const char* seriesColor(std::size_t index) {
  return kColors[index % std::size(kColors)];
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace meniscus::measure

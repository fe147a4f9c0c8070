#include "app/measure/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "app/measure/error_picture.h"
#include "app/measure/plot.h"
#include "app/measure/report_style.h"
#include "app/measure/statistics.h"
#include "app/measure/table.h"
#include "core/generated_scenes.h"
#include "io/output_file.h"

namespace meniscus::measure {

namespace {

constexpr double kErrorFloor = 1e-9;  // of the relative RMS: below float32's rounding of a distance, 3e-8
// A point is as good as exact: nothing wrong but the rounding of the stored distance, and a little.
constexpr double kGoodError = 1e-6;

std::string shortNumber(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return "∞";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size >= 1e6 || size < 1e-3) return fmt::format("{:.1e}", value);
  if (size >= 100) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string bytesText(double bytes) {
  if (std::isnan(bytes)) return "–";
  return bytes >= 1e6 ? fmt::format("{:.1f} MB", bytes / 1e6) : fmt::format("{:.0f} kB", bytes / 1e3);
}

std::string cell(const std::string& text, const char* kind = "") {
  return fmt::format("<td{}>{}</td>", *kind != 0 ? fmt::format(" class=\"{}\"", kind) : "", text);
}

class Report {
 public:
  Report(const Sweep& sweep, const OutputFolder& folder)
      : sweep_(sweep),
        folder_(folder),
        points_(folder / "points.csv"),
        details_(folder / "details.csv"),
        passes_(folder / "passes.csv"),
        cells_(folder / "cells.csv"),
        shadows_(folder / "shadows.csv"),
        leaving_(folder / "leaving_out.csv"),
        papers_(folder / "papers.csv") {
    for (std::size_t i = 0; i < points_.size(); ++i) colorOf(points_.text(i, "method"));
  }
  std::string html();

 private:
  struct Group {
    std::string scene, view, size;
    std::vector<std::size_t> rows;
    bool scaling = true;  // no parameter varies
  };
  std::size_t colorOf(const std::string& method) {
    return colors_.try_emplace(method, colors_.size()).first->second;
  }
  std::string setting(std::size_t i) const {
    const std::string& parameter = points_.text(i, "parameter");
    return parameter.empty() ? "defaults" : parameter + " = " + points_.text(i, "value");
  }
  double wrong(std::size_t i) const { return points_.number(i, "missed") + points_.number(i, "false"); }
  double pixels(std::size_t i) const { return points_.number(i, "width") * points_.number(i, "height"); }
  std::size_t detailOf(std::size_t i) const;
  std::string pictureOf(std::size_t i) const { return details_.text(detailOf(i), "picture"); }
  std::vector<Group> groups() const;
  PlotPoint plotPoint(std::size_t i, double x, double y) const;
  void header();
  void sectionHead(const char* id, const char* name, const std::string& text);
  void workPrecision();
  void finding(const Group& group);
  void scaling();
  void pictures();
  std::string passBar(std::size_t i) const;
  void pointTable();
  void matrix();
  void shadows();
  void papers();
  void leavingOut();
  void plainTable(const Table& table, const char* anchor,
                  const std::vector<std::pair<std::string, std::string>>& columns);
  std::string legendOf(const std::vector<std::string>& methods);

  const Sweep& sweep_;
  const OutputFolder& folder_;
  Table points_, details_, passes_, cells_, shadows_, leaving_, papers_;
  std::map<std::string, std::size_t> colors_;
  std::string out_;
  std::vector<std::pair<const char*, const char*>> sections_;
};

void Report::sectionHead(const char* id, const char* name, const std::string& text) {
  sections_.emplace_back(id, name);
  out_ += fmt::format("<section id=\"{}\"><h2>{}</h2><p>{}</p>\n", id, name, text);
}

// The row of details.csv with the same key.
std::size_t Report::detailOf(std::size_t i) const {
  std::size_t d = 0;
  for (; d < details_.size(); ++d) {
    bool same = true;
    for (const char* key : {"scene", "view", "width", "height", "method", "parameter", "value"})
      same = same && details_.text(d, key) == points_.text(i, key);
    if (same) break;
  }
  return d;
}

std::vector<Report::Group> Report::groups() const {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string size = points_.text(i, "width") + "×" + points_.text(i, "height");
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.scene == points_.text(i, "scene") && g.view == points_.text(i, "view") && g.size == size;
    });
    Group& group =
        found != groups.end()
            ? *found
            : groups.emplace_back(Group{points_.text(i, "scene"), points_.text(i, "view"), size, {}, true});
    group.rows.push_back(i);
    if (!points_.text(i, "parameter").empty()) group.scaling = false;
  }
  std::set<std::string> scaled;
  for (const SceneSpec& scene : sweep_.scaling) scaled.insert(scene.name);
  for (Group& group : groups) group.scaling = scaled.count(group.scene) > 0;
  return groups;
}

PlotPoint Report::plotPoint(std::size_t i, double x, double y) const {
  const std::string picture = sweep_.images ? "#" + pictureOf(i) : fmt::format("#row{}", Table::lineOf(i));
  return {
      x, y, picture,
      fmt::format("{}, {}\n{} ms (median), 95 %: {} ms\nrelative RMS {}, missed {}, false {}\n{}",
                  points_.text(i, "method"), setting(i), shortNumber(points_.number(i, "ms_median")),
                  shortNumber(points_.number(i, "ms_p95")), shortNumber(points_.number(i, "rms_relative")),
                  points_.text(i, "missed"), points_.text(i, "false"), points_.source(i)),
      false};
}

std::string Report::legendOf(const std::vector<std::string>& methods) {
  std::string text = "<div class=\"legend\">";
  for (const std::string& method : methods)
    text += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", seriesColor(colorOf(method)),
                        escaped(method));
  return text + "</div>";
}

void Report::header() {
  std::ifstream file(folder_ / "sidecar.json", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto value = [&](const char* key) {
    if (!json.is_object() || !json.contains(key)) return std::string("?");
    return escaped(json[key].is_string() ? json[key].get<std::string>() : json[key].dump());
  };
  out_ += fmt::format(
      "<header><div><h1>Meniscus, measured: {}</h1><p>{} · {} · {} threads</p><p>version {} "
      "({}) · {} · seed {} · {} repetitions, interleaved</p></div></header>\n",
      value("name"), value("device"), value("cpu"), value("threads"), value("version"), value("commit"),
      value("driver"), value("seed"), value("repetitions"));
}

void Report::finding(const Group& group) {
  std::size_t best = points_.size(), least = points_.size();
  for (const std::size_t i : group.rows) {
    const double ms = points_.number(i, "ms_median"), error = points_.number(i, "rms_relative");
    if (std::isnan(ms)) continue;
    if (wrong(i) == 0 && error <= kGoodError &&
        (best == points_.size() || ms < points_.number(best, "ms_median")))
      best = i;
    if (least == points_.size() || wrong(i) < wrong(least) ||
        (wrong(i) == wrong(least) && error < points_.number(least, "rms_relative")))
      least = i;
  }
  if (best < points_.size()) {
    out_ += fmt::format(
        "<div class=\"finding\">Fastest without a wrong pixel, relative RMS at most {:g}: <b>{}</b>, {}, "
        "{} ms (<a href=\"#row{}\">{}</a>).</div>\n",
        kGoodError, escaped(points_.text(best, "method")), escaped(setting(best)),
        shortNumber(points_.number(best, "ms_median")), Table::lineOf(best), points_.source(best));
  } else if (least < points_.size()) {
    out_ += fmt::format(
        "<div class=\"finding none\">No point is without a wrong pixel and within {:g}; nearest comes "
        "<b>{}</b>, {}: {:.0f} wrong pixels, relative RMS {} (<a href=\"#row{}\">{}</a>).</div>\n",
        kGoodError, escaped(points_.text(least, "method")), escaped(setting(least)), wrong(least),
        shortNumber(points_.number(least, "rms_relative")), Table::lineOf(least), points_.source(least));
  }
}

void Report::workPrecision() {
  const std::vector<Group> all = groups();
  if (std::none_of(all.begin(), all.end(), [](const Group& g) { return !g.scaling; })) return;
  sectionHead(
      "precision", "Work and precision",
      "Error against time, both logarithmic; below and to the left is better. A line is a method, its "
      "points its parameter. Filled points are on the Pareto front (dotted): nothing is both faster "
      "and more exact. Hover for numbers, click for the picture of the error.");
  int files = 0;
  for (const Group& group : all) {
    if (group.scaling) continue;
    std::vector<std::string> methods;
    Plot error{"Relative RMS of the ray parameter",
               "ms per picture (median)",
               "relative RMS",
               kErrorFloor,
               "1e-9 or less",
               true,
               {}};
    const double floor = std::pow(10, std::floor(std::log10(1 / pixels(group.rows.front()))));
    Plot wrongs{"Missed and false pixels, share of the picture",
                "ms per picture (median)",
                "wrong pixels, share",
                floor,
                "none",
                true,
                {}};
    for (const std::size_t i : group.rows) {
      const std::string& method = points_.text(i, "method");
      // Another parameter of the same method is another line.
      const auto found = std::find(methods.begin(), methods.end(), method);
      const auto at = static_cast<std::size_t>(found - methods.begin());
      if (found == methods.end()) {
        methods.push_back(method);
        error.series.push_back({method, {}});
        wrongs.series.push_back({method, {}});
      }
      const double ms = points_.number(i, "ms_median");
      if (std::isnan(ms)) continue;
      const double rms = points_.number(i, "rms_relative"), share = wrong(i) / pixels(i);
      error.series[at].points.push_back(plotPoint(i, ms, rms));
      wrongs.series[at].points.push_back(plotPoint(i, ms, share));
    }
    for (Plot* plot : {&error, &wrongs}) {
      std::vector<XY> xy;
      for (const PlotSeries& s : plot->series)
        for (const PlotPoint& p : s.points) xy.push_back({p.x, std::max(p.y, plot->yFloor)});
      const std::vector<bool> front = paretoFront(xy);
      std::size_t next = 0;
      for (PlotSeries& s : plot->series)
        for (PlotPoint& p : s.points) p.front = front[next++];
    }
    std::vector<std::size_t> colors;
    for (const std::string& method : methods) colors.push_back(colorOf(method));
    out_ += fmt::format("<h3>{}, {} view, {}, {} balls</h3>\n", escaped(group.scene), escaped(group.view),
                        group.size, points_.text(group.rows.front(), "atoms"));
    out_ += legendOf(methods);
    out_ +=
        fmt::format("<div class=\"pair\"><div class=\"plot\">{}</div><div class=\"plot\">{}</div></div>\n",
                    svgOf(error, colors), svgOf(wrongs, colors));
    finding(group);
    error.title = fmt::format("{}, {} view, {}, {} balls", group.scene, group.view, group.size,
                              points_.text(group.rows.front(), "atoms"));
    writeTextFile(folder_ / fmt::format("precision-{}.svg", ++files), svgFileOf(error, colors));
  }
  out_ += "</section>\n";
}

void Report::scaling() {
  std::vector<std::string> methods;
  Plot time{"Time against number of balls", "balls", "ms per picture (median)", 0, "", false, {}};
  for (const Group& group : groups()) {
    if (!group.scaling) continue;
    for (const std::size_t i : group.rows) {
      const std::string& method = points_.text(i, "method");
      const auto found = std::find(methods.begin(), methods.end(), method);
      const auto at = static_cast<std::size_t>(found - methods.begin());
      if (found == methods.end()) {
        methods.push_back(method);
        time.series.push_back({method, {}});
      }
      PlotPoint point = plotPoint(i, points_.number(i, "atoms"), points_.number(i, "ms_median"));
      point.front = true;
      time.series[at].points.push_back(point);
    }
  }
  if (methods.empty()) return;
  for (PlotSeries& s : time.series)
    std::sort(s.points.begin(), s.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  std::vector<std::size_t> colors;
  for (const std::string& method : methods) colors.push_back(colorOf(method));
  writeTextFile(folder_ / "scaling.svg", svgFileOf(time, colors));
  sectionHead(
      "scaling", "More balls",
      "Packed as densely as a protein's atoms, the whole of it filling the picture; every method with "
      "its defaults.");
  out_ +=
      legendOf(methods) +
      fmt::format("<div class=\"pair\"><div class=\"plot\">{}</div></div></section>\n", svgOf(time, colors));
}

std::string Report::passBar(std::size_t i) const {
  std::vector<std::pair<double, std::string>> parts;
  double total = 0;
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    bool same = true;
    for (const char* key : {"scene", "view", "width", "height", "method", "parameter", "value"})
      same = same && passes_.text(p, key) == points_.text(i, key);
    if (!same) continue;
    const double ms = passes_.number(p, "ms_median");
    parts.emplace_back(ms, fmt::format("{}: {} ms in {} runs ({})", passes_.text(p, "pass"), shortNumber(ms),
                                       passes_.text(p, "runs"), passes_.source(p)));
    total += ms;
  }
  if (!(total > 0)) return "";
  std::string text = "<div class=\"bar\">";
  for (std::size_t p = 0; p < parts.size(); ++p)
    text += fmt::format("<span style=\"width:{:.2f}%;background:{}\" title=\"{}\"></span>",
                        100 * parts[p].first / total, seriesColor(p), escaped(parts[p].second));
  return text + "</div>";
}

void Report::pictures() {
  if (!sweep_.images || points_.empty()) return;
  sectionHead(
      "pictures", "Where it is wrong",
      "On the left what was drawn, on the right how far it is from the truth: double precision, every "
      "root proven. Where the picture is made smaller, the worst of some pixels is shown. The bar under "
      "a picture is where the time went, pass by pass.");
  out_ += "<div class=\"scale\">";
  for (const LegendEntry& entry : errorLegend())
    out_ += fmt::format("<span><i style=\"background:#{:06x}\"></i>{}</span>", entry.color, entry.meaning);
  out_ += "</div><div class=\"cards\">\n";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string picture = pictureOf(i);
    const bool refused = points_.text(i, "ms_median").empty();
    out_ += fmt::format("<div class=\"card\" id=\"{}\">", picture);
    if (!refused)
      out_ += fmt::format(
          "<a href=\"images/{0}.png\"><img loading=\"lazy\" src=\"images/{0}.png\" alt=\"picture and error "
          "of "
          "{1}\"></a>",
          picture, escaped(points_.text(i, "method")));
    out_ +=
        fmt::format("<div><b>{}</b>, {}<br>{}, {} view<br>", escaped(points_.text(i, "method")),
                    escaped(setting(i)), escaped(points_.text(i, "scene")), escaped(points_.text(i, "view")));
    out_ += refused ? std::string("refused<br>")
                    : fmt::format("{} ms · RMS {} · {:.0f} wrong pixels<br>",
                                  shortNumber(points_.number(i, "ms_median")),
                                  shortNumber(points_.number(i, "rms_relative")), wrong(i));
    out_ += fmt::format("<small><a href=\"#row{}\">{}</a></small>{}</div></div>\n", Table::lineOf(i),
                        points_.source(i), passBar(i));
  }
  out_ += "</div></section>\n";
}

void Report::pointTable() {
  if (points_.empty()) return;
  sectionHead("points", "All points",
              "<a href=\"points.csv\">points.csv</a>; the number of a row is its line there. PSNR and "
              "largest: of the "
              "picture lit from the eye, against the truth lit the same way. Times per pass: "
              "<a href=\"passes.csv\">passes.csv</a>; what else was counted: <a "
              "href=\"details.csv\">details.csv</a>.");
  out_ += "<div class=\"scroll\"><table><tr><th>line</th>";
  constexpr const char* kHeads[] = {
      "scene", "balls",    "view",          "size",    "method",           "setting",
      "ms",    "ms 95 %",  "missed",        "false",   "grazing",          "relative RMS",
      "p99 Å", "max Å",    "normals RMS °", "PSNR dB", "picture: largest", "iterations",
      "most",  "overflow", "not converged", "memory"};
  for (std::size_t h = 0; h < std::size(kHeads); ++h)
    out_ +=
        fmt::format("<th{}>{}</th>", h == 0 || h == 2 || h == 4 || h == 5 ? " class=\"t\"" : "", kHeads[h]);
  out_ += "</tr>\n";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    out_ += fmt::format("<tr id=\"row{0}\"><td>{0}</td>", Table::lineOf(i));
    out_ +=
        cell(escaped(points_.text(i, "scene")), "t") + cell(points_.text(i, "atoms")) +
        cell(escaped(points_.text(i, "view")), "t") +
        cell(points_.text(i, "width") + "×" + points_.text(i, "height")) +
        cell(fmt::format("<a href=\"#{}\">{}</a>", pictureOf(i), escaped(points_.text(i, "method"))), "t") +
        cell(escaped(setting(i)), "t");
    for (const char* column : {"ms_median", "ms_p95"}) out_ += cell(shortNumber(points_.number(i, column)));
    for (const char* column : {"missed", "false", "grazing"}) out_ += cell(points_.text(i, column));
    for (const char* column : {"rms_relative", "p99_angstrom", "max_angstrom", "normal_rms_deg"})
      out_ += cell(shortNumber(points_.number(i, column)));
    for (const char* column : {"picture_psnr_db", "picture_largest"})
      out_ += cell(shortNumber(details_.number(detailOf(i), column)));
    out_ += cell(shortNumber(points_.number(i, "iterations_mean")));
    for (const char* column : {"iterations_max", "overflow", "not_converged"})
      out_ += cell(points_.text(i, column));
    out_ += cell(bytesText(points_.number(i, "bytes"))) + "</tr>\n";
  }
  out_ += "</table></div></section>\n";
}

void Report::matrix() {
  if (cells_.empty()) return;
  std::vector<std::string> methods, scenes;
  std::map<std::pair<std::string, std::string>, std::size_t> at;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::string &method = cells_.text(i, "method"), &scene = cells_.text(i, "scene");
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
    at[{method, scene}] = i;
  }
  sectionHead(
      "stability", "Stiff and extreme scenes",
      "Each cell is drawn in a process of its own that may hang or crash. <b>Exact</b>: no pixel missed "
      "or false, 99 % of the distances right to 1e-4 of the scene's detail (and float32's rounding), "
      "normals to 0.1°. <b>Degraded</b>: by how much: the share of wrong pixels, or the error in units "
      "of the detail, or the normals. <b>Refused</b>: with a message. Click for the picture. All "
      "numbers: <a href=\"cells.csv\">cells.csv</a>.");
  out_ += "<div class=\"scroll\"><table class=\"matrix\"><tr><th class=\"t\">scene: what it stresses</th>";
  for (const std::string& method : methods) out_ += fmt::format("<th>{}</th>", escaped(method));
  out_ += "</tr>\n";
  for (const std::string& scene : scenes) {
    std::string stresses;
    for (const StabilityRecipe& recipe : stabilityRecipes())
      if (recipe.name == scene) stresses = recipe.stresses;
    out_ +=
        fmt::format("<tr><td class=\"t\"><b>{}</b><small>{}</small></td>", escaped(scene), escaped(stresses));
    for (const std::string& method : methods) {
      const auto found = at.find({method, scene});
      if (found == at.end()) {
        out_ += cell("not measured", "failed");
        continue;
      }
      const std::size_t i = found->second;
      const std::string& status = cells_.text(i, "status");
      std::string kind = status, text = status;
      if (status == "failed")
        text = escaped(cells_.text(i, "message").substr(0, cells_.text(i, "message").find(':')));
      const double share = cells_.number(i, "wrong_share"), p99 = cells_.number(i, "p99_detail"),
                   normal = cells_.number(i, "normal_rms_deg");
      if (status == "degraded") {
        text = share > 0                    ? fmt::format("{} % wrong", shortNumber(100 * share))
               : normal > 0.1 && p99 < 1e-2 ? fmt::format("normals {}°", shortNumber(normal))
                                            : fmt::format("off by {} detail", shortNumber(p99));
        kind = share < 1e-3 && p99 < 1e-2 ? "slight" : share > 0.05 || p99 > 1 ? "bad" : "degraded";
      }
      const std::string title = fmt::format(
          "{} of {}: missed {}, false {}, grazing {} of {} pixels; p99 {} Å, most {} Å; normals {}°; {} ms; "
          "{}{}",
          status, method, cells_.text(i, "missed"), cells_.text(i, "false"), cells_.text(i, "grazing"),
          cells_.text(i, "pixels"), shortNumber(cells_.number(i, "p99_angstrom")),
          shortNumber(cells_.number(i, "max_angstrom")), shortNumber(normal),
          shortNumber(cells_.number(i, "ms")),
          cells_.text(i, "message").empty() ? "" : cells_.text(i, "message") + "; ", cells_.source(i));
      const std::string& picture = cells_.text(i, "picture");
      out_ += fmt::format("<td class=\"{}\" title=\"{}\"><a href=\"{}\">{}</a></td>", kind, escaped(title),
                          picture.empty() ? "cells.csv" : escaped(picture), text);
    }
    out_ += "</tr>\n";
  }
  out_ += "</table></div></section>\n";
}

// Columns by name and heading; `anchor` and the line name a row.
void Report::plainTable(const Table& table, const char* anchor,
                        const std::vector<std::pair<std::string, std::string>>& columns) {
  out_ += "<div class=\"scroll\"><table><tr><th>line</th>";
  for (const auto& [name, heading] : columns)
    out_ += fmt::format("<th{}>{}</th>", std::isnan(table.number(0, name)) ? " class=\"t\"" : "", heading);
  out_ += "</tr>\n";
  for (std::size_t i = 0; i < table.size(); ++i) {
    out_ += fmt::format("<tr id=\"{0}{1}\"><td>{1}</td>", anchor, Table::lineOf(i));
    for (const auto& [name, heading] : columns) {
      const double number = table.number(i, name);
      const bool bytes = name == "bytes", text = std::isnan(number);
      out_ += cell(bytes  ? bytesText(number)
                   : text ? escaped(table.text(i, name))
                          : shortNumber(number),
                   !text                             ? ""
                   : table.text(i, name).size() > 40 ? "wrap"
                                                     : "t");
    }
    out_ += "</tr>\n";
  }
  out_ += "</table></div>\n";
}

void Report::shadows() {
  if (shadows_.empty()) return;
  sectionHead("shadows", "Soft shadows",
              "Error of the share of light that arrives, over the pixels that face the light, against 4,096 "
              "samples of the same shadow map. Filled marks are adaptive: probes "
              "first, all samples only where they disagree. Source: <a "
              "href=\"shadows.csv\">shadows.csv</a>.");
  Plot plot{"Error against time", "shadow pass, ms (median)", "RMS of the light's share", 0, "", false, {}};
  std::vector<std::size_t> colors;
  std::vector<std::string> scenes;
  for (std::size_t i = 0; i < shadows_.size(); ++i) {
    const std::string& scene = shadows_.text(i, "scene");
    const bool adaptive = shadows_.number(i, "probes") > 0;
    const std::string series = scene + (adaptive ? ", adaptive" : "");
    auto found = std::find_if(plot.series.begin(), plot.series.end(),
                              [&](const PlotSeries& s) { return s.name == series; });
    if (found == plot.series.end()) {
      const auto known = std::find(scenes.begin(), scenes.end(), scene);
      colors.push_back(static_cast<std::size_t>(known - scenes.begin()));
      if (known == scenes.end()) scenes.push_back(scene);
      found = plot.series.insert(plot.series.end(), {series, {}});
    }
    found->points.push_back({shadows_.number(i, "pass_ms"), shadows_.number(i, "rms"),
                             fmt::format("#shadow{}", Table::lineOf(i)),
                             fmt::format("{}\n{} samples, {} probes\n{}", scene, shadows_.text(i, "samples"),
                                         shadows_.text(i, "probes"), shadows_.source(i)),
                             adaptive});
  }
  out_ += "<div class=\"legend\">";
  for (std::size_t s = 0; s < scenes.size(); ++s)
    out_ += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", seriesColor(s), escaped(scenes[s]));
  out_ += fmt::format("</div><div class=\"pair\"><div class=\"plot\">{}</div></div>\n", svgOf(plot, colors));
  plainTable(shadows_, "shadow",
             {{"scene", "scene"},
              {"penumbra", "penumbra Å"},
              {"samples", "samples"},
              {"probes", "probes"},
              {"rms", "RMS"},
              {"largest", "largest"},
              {"pass_ms", "pass ms"},
              {"frame_ms", "frame ms"},
              {"samples_taken", "samples taken"},
              {"penumbra_share", "in penumbra"}});
  out_ += "</section>\n";
}

void Report::papers() {
  if (papers_.empty()) return;
  sectionHead("papers", "The papers' tables, here",
              "Machines differ by more than methods do, so what is compared are ratios: each row against the "
              "first of its table, in the paper and here. Source: <a href=\"papers.csv\">papers.csv</a>.");
  plainTable(papers_, "paper",
             {{"paper", "paper"},
              {"table", "table"},
              {"row", "row"},
              {"method", "method here"},
              {"paper_ms", "paper ms"},
              {"paper_ratio", "paper, ratio"},
              {"here_ms", "here ms"},
              {"here_ratio", "here, ratio"},
              {"why", "where they differ, and why"}});
  out_ += "</section>\n";
}

void Report::leavingOut() {
  if (leaving_.empty()) return;
  sectionHead(
      "leaving", "What a scene does not need is left out",
      "Programs compiled, passes run and memory taken by kinds of scenes, each in a renderer of its own; "
      "the first picture compiles and uploads, the steady one does not. Source: <a "
      "href=\"leaving_out.csv\">leaving_out.csv</a>.");
  plainTable(leaving_, "leaving",
             {{"scene", "scene"},
              {"programs", "programs"},
              {"passes", "passes run"},
              {"bytes", "memory"},
              {"first_ms", "first ms"},
              {"steady_ms", "steady ms"}});
  out_ += "</section>\n";
}

std::string Report::html() {
  workPrecision();
  scaling();
  matrix();
  shadows();
  papers();
  leavingOut();
  pictures();
  pointTable();
  std::string body = std::move(out_);
  out_ =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">";
  out_ += fmt::format("<title>Meniscus: {}</title><style>{}</style></head><body>\n", escaped(sweep_.name),
                      kReportStyle);
  header();
  out_ += "<nav><div>";
  for (const auto& [id, name] : sections_) out_ += fmt::format("<a href=\"#{}\">{}</a>", id, name);
  out_ += "</div></nav><main>\n" + body +
          "<footer>Written by <code>meniscus measure</code>; columns and scenes are described in "
          "docs/measuring.md. <a href=\"sidecar.json\">sidecar.json</a> holds the sweep and the "
          "machine.</footer></main></body></html>\n";
  return out_;
}

}  // namespace

void writeReport(const Sweep& sweep, const OutputFolder& folder) {
  writeTextFile(folder / "report.html", Report(sweep, folder).html());
}

}  // namespace meniscus::measure

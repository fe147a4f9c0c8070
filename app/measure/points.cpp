#include "app/measure/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/measure/statistics.h"
#include "render/surface_method.h"

namespace meniscus::measure {

namespace {

void addPoints(PlannedGroup& group, const MethodLine& line, std::size_t& number) {
  PlannedPoint point;
  point.label = line.label();
  point.settings.method = line.method;
  point.settings.parameters = line.options;
  point.parameter = line.parameter;
  if (line.parameter.empty()) {
    point.number = ++number;
    group.points.push_back(point);
    return;
  }
  for (const double value : line.values) {
    point.number = ++number;
    point.settings.parameters[line.parameter] = value;
    point.value = numberText(value);
    group.points.push_back(point);
  }
}

std::string whole(std::uint64_t value) {
  return fmt::format("{}", value);
}

}  // namespace

std::vector<PlannedGroup> planOf(const Sweep& sweep) {
  std::vector<PlannedGroup> plan;
  std::size_t number = 0;
  const auto addGroup = [&](const SceneSpec& scene, const ViewSpec& view, ImageSize size,
                            const std::vector<MethodLine>& lines) {
    PlannedGroup group{scene, view, size, {}};
    for (const MethodLine& line : lines) addPoints(group, line, number);
    plan.push_back(std::move(group));
  };
  for (const SceneSpec& scene : sweep.scenes) {
    // A stability scene has one view, its own.
    std::vector<ViewSpec> views = sweep.views;
    if (!scene.stability.empty()) {
      views.resize(1);
      views[0] = {};
      views[0].name = "own";
    }
    for (const ViewSpec& view : views)
      for (const ImageSize& size : sweep.sizes) addGroup(scene, view, size, sweep.lines);
  }
  std::vector<MethodLine> defaults;
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    MethodLine line;
    line.method = std::string(method.name);
    defaults.push_back(line);
  }
  for (const SceneSpec& scene : sweep.scaling) addGroup(scene, {}, sweep.sizes.front(), defaults);
  return plan;
}

Row keyOf(const PlannedGroup& group, const PlannedPoint& point) {
  return {group.scene.name,
          group.view.name,
          fmt::format("{}", group.size.width),
          fmt::format("{}", group.size.height),
          point.label,
          point.parameter,
          point.value};
}

Row keyOfPointRow(const Row& row) {
  return {row[0], row[2], row[3], row[4], row[5], row[6], row[7]};
}

std::string pictureName(std::size_t number) {
  return fmt::format("p{:04}", number);
}

Row PointTables::pointColumns() {
  return {
      "scene",          "atoms",        "view",          "width",        "height",         "method",
      "parameter",      "value",        "ms_median",     "ms_p95",       "missed",         "false",
      "grazing",        "rms_relative", "p99_angstrom",  "max_angstrom", "normal_rms_deg", "iterations_mean",
      "iterations_max", "overflow",     "not_converged", "bytes"};
}

Row PointTables::passColumns() {
  return {"scene", "view", "width", "height", "method", "parameter", "value", "pass", "runs", "ms_median"};
}

Row PointTables::detailColumns() {
  return {"scene",           "view",           "width",       "height",
          "method",          "parameter",      "value",       "repetitions",
          "prepare_ms",      "processor_ms",   "compared",    "grazing_disputes",
          "ids_differ",      "normal_max_deg", "picture_rms", "picture_psnr_db",
          "picture_largest", "picture",        "refused"};
}

PointTables::PointTables(const OutputFolder& folder)
    : passes_(folder / "passes.csv", passColumns()),
      details_(folder / "details.csv", detailColumns()),
      points_(folder / "points.csv", pointColumns()) {
  // A run that ended between the tables left rows of a point that is not there.
  std::set<Row> there;
  for (const Row& row : points_.rows()) there.insert(keyOfPointRow(row));
  const auto isThere = [&](const Row& row) { return there.count(Row(row.begin(), row.begin() + 7)) > 0; };
  passes_.keepIf(isThere);
  details_.keepIf(isThere);
}

bool PointTables::has(const PlannedGroup& group, const PlannedPoint& point) const {
  const Row key = keyOf(group, point);
  return std::any_of(points_.rows().begin(), points_.rows().end(),
                     [&](const Row& row) { return keyOfPointRow(row) == key; });
}

void PointTables::add(const PlannedGroup& group, const PlannedPoint& point, const PointResult& result) {
  const Row key = keyOf(group, point);
  const auto withKey = [&](Row rest) {
    rest.insert(rest.begin(), key.begin(), key.end());
    return rest;
  };
  const HitErrors& e = result.errors;
  const SurfaceStats& s = result.stats;
  const bool known = result.refused.empty();
  std::vector<Row> passes;
  for (const PointResult::Pass& pass : result.passes)
    passes.push_back(withKey({pass.name, fmt::format("{}", pass.runs), numberText(median(pass.ms))}));
  passes_.append(passes);
  Row seen(3);  // unknown
  if (result.picture)
    seen = {numberText(result.picture->rms), numberText(result.picture->psnr),
            numberText(result.picture->largest)};
  details_.append({withKey({fmt::format("{}", result.ms.size()), numberText(median(result.prepareMs)),
                            numberText(median(result.processorMs)), whole(e.compared),
                            whole(e.grazingDisputes), whole(e.idsDiffer), numberText(e.largestNormalDeg),
                            seen[0], seen[1], seen[2], pictureName(point.number), result.refused})});
  Row row = {key[0], whole(result.atoms), key[1], key[2], key[3], key[4], key[5], key[6]};
  const double iterations =
      s.pixels > 0 ? static_cast<double>(s.iterations) / static_cast<double>(s.pixels) : 0;
  Row numbers = {numberText(median(result.ms)),
                 numberText(quantile(result.ms, 0.95)),
                 whole(e.missed),
                 whole(e.falseHits),
                 whole(e.grazing),
                 numberText(e.relativeRms),
                 numberText(e.distanceP99),
                 numberText(e.largestDistance),
                 numberText(e.normalRmsDeg),
                 numberText(iterations),
                 whole(s.mostIterations),
                 whole(s.overflow),
                 whole(s.notConverged),
                 whole(result.bytes)};
  if (!known) std::fill(numbers.begin(), numbers.end(), "");
  row.insert(row.end(), numbers.begin(), numbers.end());
  points_.append({row});
}

}  // namespace meniscus::measure

#pragma once
// The points of surface methods: what is to be measured, and the tables that it goes to.

#include <optional>
#include <string>
#include <vector>

#include "app/measure/csv.h"
#include "app/measure/output_folder.h"
#include "app/measure/picture_difference.h"
#include "app/measure/sweep.h"
#include "core/hit_errors.h"
#include "render/render_stats.h"

namespace meniscus::measure {

struct PlannedPoint {
  std::size_t number = 0;  ///< names its picture: images/p0001.png
  std::string label;       ///< method and fixed options
  SurfaceSettings settings;
  std::string parameter, value;  ///< as in the tables; empty if nothing varies
};

/// What is measured interleaved: the same scene, view and size.
struct PlannedGroup {
  SceneSpec scene;
  ViewSpec view;
  ImageSize size;
  std::vector<PlannedPoint> points;
};

/// All points of scenes x views x sizes x lines and of the scaling, numbered from 1.
std::vector<PlannedGroup> planOf(const Sweep& sweep);

/// What was measured of a point.
struct PointResult {
  std::size_t atoms = 0;
  std::vector<double> ms, processorMs;
  HitErrors errors;
  std::optional<PictureDifference> picture;  ///< as people see it, against the truth lit the same way
  SurfaceStats stats;
  std::uint64_t bytes = 0;
  std::vector<double> prepareMs;
  struct Pass {
    std::string name;
    int runs = 0;
    std::vector<double> ms;
  };
  std::vector<Pass> passes;
  std::string refused;  ///< message; then nothing else is known
};

/// points.csv, passes.csv and details.csv of a folder. A point is there if it is in points.csv.
class PointTables {
 public:
  explicit PointTables(const OutputFolder& folder);
  bool has(const PlannedGroup& group, const PlannedPoint& point) const;
  void add(const PlannedGroup& group, const PlannedPoint& point, const PointResult& result);
  const GrowingCsv& points() const { return points_; }
  const GrowingCsv& passes() const { return passes_; }
  const GrowingCsv& details() const { return details_; }

  static Row pointColumns();
  static Row passColumns();
  static Row detailColumns();

 private:
  GrowingCsv passes_, details_, points_;
};

/// The fields that tell a point from the others: scene, view, width, height, method, parameter, value.
Row keyOf(const PlannedGroup& group, const PlannedPoint& point);
/// The same of a row of points.csv.
Row keyOfPointRow(const Row& row);

std::string pictureName(std::size_t number);  ///< "p0001"

}  // namespace meniscus::measure

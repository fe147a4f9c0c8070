#pragma once
// Diagrams as SVG, inline in a page: log-log, a line per series, each point a link.

#include <string>
#include <vector>

namespace meniscus::measure {

struct PlotPoint {
  double x = 0, y = 0;
  std::string link, title;  ///< where a click leads; what hovering says
  bool front = false;       ///< on the Pareto front
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;  ///< in the order of their parameter
};

struct Plot {
  std::string title, xLabel, yLabel;
  double yFloor = 0;       ///< > 0: smaller values, 0 too, are drawn here, below a dashed line
  std::string floorLabel;  ///< "none"
  bool joinFront = false;
  std::vector<PlotSeries> series;
};

/// Points that are not positive and finite are left out, but for those that yFloor is for. `colors`: index
/// of each series' colour, so that a name has the same in all diagrams.
std::string svgOf(const Plot& plot, const std::vector<std::size_t>& colors);

/// The same as a file of its own, with a legend in it.
std::string svgFileOf(const Plot& plot, const std::vector<std::size_t>& colors);

/// Colour of an index, "#rrggbb"; they repeat after ten.
const char* seriesColor(std::size_t index);

/// &, <, > and quotes as entities.
std::string escaped(const std::string& text);

}  // namespace meniscus::measure

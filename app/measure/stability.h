#pragma once
// The stability matrix: every way to draw on every stiff or extreme scene (core/generated_scenes.h), each
// cell in a process that may hang or crash without harm.

#include <optional>
#include <string>
#include <vector>

#include "app/measure/csv.h"
#include "app/measure/output_folder.h"
#include "app/measure/sweep.h"
#include "app/progress.h"
#include "core/hit_errors.h"
#include "core/hit_image.h"
#include "core/reference_tracer.h"
#include "core/render_settings.h"
#include "render/gl/context.h"

namespace meniscus::measure {

/// How a cell ended.
struct Cell {
  enum class Status : std::uint8_t { exact, degraded, refused, failed } status = Status::failed;
  double wrongShare = 0;  ///< missed and false pixels among those that do not graze
  double p99Detail = 0;   ///< 99 % of the distances are wrong by at most this, in units of the scene's detail
  double normalRmsDeg = 0;  ///< [degrees]
  HitErrors errors;
  std::string message;  ///< what was refused, or how it failed
};

const char* nameOf(Cell::Status status);

/// Judges a picture. Exact: no pixel missed or false, 99 % of the distances within 1e-4 of the detail and a
/// rounding of float32, normals within 0.1 degrees. Failed: a number in it is not one.
Cell judgeCell(const HitImage& image, const ReferenceImage& truth, double detail);

/// Ways to draw quadrics, by the names they have beside the surface methods.
struct NamedQuadricMethod {
  const char* name;
  QuadricMethod method;
};
inline constexpr NamedQuadricMethod kQuadricMethods[] = {{"quadrics-splat", QuadricMethod::splat},
                                                         {"quadrics-tiles", QuadricMethod::tiles},
                                                         {"quadrics-tiles_glsl", QuadricMethod::tilesGlsl}};
/// Nothing if it is not one of them.
std::optional<QuadricMethod> quadricMethodNamed(const std::string& name);
/// Columns of the matrix: every way to draw quadrics, and every surface method.
std::vector<std::string> stabilityMethods();

Row cellColumns();

/// All cells that are not there yet, into cells.csv, and stability.json with all of them. `arguments`: the
/// sweep and the options that the command was given, for the processes that draw.
void measureStability(const Sweep& sweep, const std::vector<std::string>& arguments,
                      const OutputFolder& folder, Progress& progress);

/// The other process: draws the cells of one method, in order. Makes a context of its own.
void drawCells(const Sweep& sweep, const OutputFolder& folder, const std::string& method, Backend backend);

}  // namespace meniscus::measure

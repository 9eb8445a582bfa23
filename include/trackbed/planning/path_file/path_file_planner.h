#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"
#include "trackbed/planning/common/planner.h"

/// The path of another program as a plan.
namespace trackbed {

enum class PathSpeeds {
  kMission,  ///< the mission's speed
  kFile,     ///< those of the points, as far as the mission's and the car's limits allow
};

/// `path` is what ReadScenario read from the file and fitted, or a program: FitPath of its points.
/// The other members but `speeds` and `notes` describe how it came about; changing them does not
/// change it.
struct PathFileOptions {
  std::string file;
  PathMap map;
  double ahead = 0.0;  ///< of the rear axle, on the car's axis: the points that are given [m]
  PathFitOptions fit;
  PathSpeeds speeds = PathSpeeds::kMission;
  std::optional<std::string> notes;  ///< what was found in the file, a line for each remark
  std::shared_ptr<const FittedPath> path;
};
void Visit(KeyVisitor& keys, PathFileOptions& options);

/// How the file became a path.
struct PathFileDiagnostics {
  std::size_t points = 0;
  std::size_t repeated_points = 0;  ///< that were left out
  PathFit fit = PathFit::kSpline;
  double deviation = 0.0;           ///< largest one of the points from the path [m]
  double deviation_station = 0.0;   ///< where [m]
  double bulge = 0.0;               ///< largest one of a spline from the lines between points [m]
  double bulge_station = 0.0;       ///< about where [m]
  double smoothing_length = 0.0;    ///< of the spline, 0 without one [m]
  double heading_difference = 0.0;  ///< largest one of the file's headings from the path's [rad]
  std::size_t heading_jumps = 0;    ///< of a polyline
  double heading_jump_max = 0.0;    ///< [rad]
};
void Visit(DiagnosticsVisitor& out, const PathFileDiagnostics& own);
PathFileDiagnostics DiagnosticsOf(const FittedPath& fitted);

/// One line: "spline within 0.049 m of 120 points, smoothing length 3.1 m".
std::string Describe(const FittedPath& fitted);

/// The planner `path_file`. Its plan follows the path as it is, from its first point: obstacles are
/// not looked at. kTurnTooTight where a polyline's heading jumps, unless the request allows
/// infeasible plans; kNoPath without a path.
PlannerEntry PathFilePlanner();

}  // namespace trackbed

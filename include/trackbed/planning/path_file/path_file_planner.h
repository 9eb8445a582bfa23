#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"
#include "trackbed/planning/common/planner.h"

/// Plans along a path from another program.
namespace trackbed {

enum class PathSpeeds {
  kMission,  ///< The mission's speed.
  kFile,     ///< Speeds of the points, limited by the mission and the car.
};

/// Options of `path_file`. `path` is fitted by ReadScenario from the file, or by a program with
/// FitPath from points. The members other than `speeds` and `notes` describe the origin of the
/// path; changing them does not change the path.
struct PathFileOptions {
  std::string file;
  PathMap map;
  /// Position of the given points on the car's axis, ahead of the rear axle [m].
  double ahead = 0.0;
  PathFitOptions fit;
  PathSpeeds speeds = PathSpeeds::kMission;
  std::optional<std::string> notes;  ///< Remarks on the file, one line each.
  std::shared_ptr<const FittedPath> path;
};
void Visit(KeyVisitor& keys, PathFileOptions& options);

/// Diagnostics of the fit of a path to the file's points.
struct PathFileDiagnostics {
  std::size_t points = 0;
  std::size_t repeated_points = 0;  ///< Number of repeated points, which were left out.
  PathFit fit = PathFit::kSpline;
  double deviation = 0.0;          ///< Largest deviation of the points from the path [m].
  double deviation_station = 0.0;  ///< Station of the largest deviation [m].
  /// Largest distance of a spline from the lines between points [m].
  double bulge = 0.0;
  double bulge_station = 0.0;     ///< Approximate station of the bulge [m].
  double smoothing_length = 0.0;  ///< Smoothing length of the spline; 0 without a spline [m].
  /// Largest difference between the file's headings and the path's [rad].
  double heading_difference = 0.0;
  std::size_t heading_jumps = 0;  ///< Number of corners of a polyline.
  double heading_jump_max = 0.0;  ///< Largest corner of a polyline [rad].
};
void Visit(DiagnosticsVisitor& out, const PathFileDiagnostics& own);
PathFileDiagnostics DiagnosticsOf(const FittedPath& fitted);

/// Describes the fit in one line: "spline within 0.049 m of 120 points, smoothing length 3.1 m".
std::string Describe(const FittedPath& fitted);

/// The planner `path_file`. The plan follows the given path from the first point and ignores
/// obstacles. The status is kTurnTooTight if a polyline's heading jumps, unless the request allows
/// infeasible plans. The status is kNoPath without a path.
PlannerEntry PathFilePlanner();

}  // namespace trackbed

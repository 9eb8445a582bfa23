#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"
#include "trackbed/planning/common/planner.h"

/// Plans along a path that another program has made.
namespace trackbed {

enum class PathSpeeds {
  kMission,  ///< The car drives at the mission's speed.
  kFile,     ///< The car drives at the speeds of the points, limited by the mission and the car.
};

/// Options of the planner `path_file`. ReadScenario fits `path` to the points of the file. A
/// program can make `path` from points with FitPath. The members other than `speeds` and `notes`
/// describe the origin of the path; changing them does not change the path.
struct PathFileOptions {
  std::string file;
  PathMap map;
  /// The given points are the path of a point on the car's axis, at the distance `ahead` in front
  /// of the rear axle [m].
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
  /// Largest difference between the headings of the file and of the path [rad].
  double heading_difference = 0.0;
  std::size_t heading_jumps = 0;  ///< Number of corners of a polyline.
  double heading_jump_max = 0.0;  ///< Largest heading jump at a corner of a polyline [rad].
};
void Visit(DiagnosticsVisitor& out, const PathFileDiagnostics& own);
PathFileDiagnostics DiagnosticsOf(const FittedPath& fitted);

/// Describes the fit in one line: "spline within 0.049 m of 120 points, smoothing length 3.1 m".
std::string Describe(const FittedPath& fitted);

/// Returns the planner `path_file`. The plan follows the given path from the first point and
/// ignores obstacles. The status is kTurnTooTight if a polyline's heading jumps, unless the request
/// allows infeasible plans. If there is no path, the status is kNoPath.
PlannerEntry PathFilePlanner();

}  // namespace trackbed

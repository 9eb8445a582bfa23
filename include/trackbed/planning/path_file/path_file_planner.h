#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/path_files/path_map.h"
#include "trackbed/planning/common/planner.h"

/// Plans along a path that another program has computed and stored in a file.
namespace trackbed {

enum class PathSpeeds {
  kMission,  ///< The car drives at the mission's speed.
  /// The car drives at the speeds of the file's points, limited by the mission's speed and the
  /// car's limits. If the file has times, the car waits at the places where the car stands
  /// according to these times.
  kFile,
};

/// Options of the planner `path_file`. ReadScenario fits `path` to the points of the file. A
/// program that uses no file can compute `path` from points by FitPath. All members except
/// `speeds`, `notes` and `lanes` describe the origin of the path; changing these members does not
/// change the path.
struct PathFileOptions {
  std::string file;
  PathMap map;
  /// Distance from the rear axle forward to the point on the car's axis whose path the file
  /// contains [m].
  double ahead = 0.0;
  PathFitOptions fit;
  PathSpeeds speeds = PathSpeeds::kMission;
  /// Remarks of the reader on the contents of the path file, one per line.
  std::optional<std::string> notes;
  /// File of lanes to draw (ReadLanesCsv); nullopt: the lanes of `file`, if it has any.
  std::optional<std::string> lanes;
  std::shared_ptr<const FittedPath> path;
  DrawnLanes drawn_lanes;  ///< Lanes that films and reports show.
};
void Visit(KeyVisitor& keys, PathFileOptions& options);

/// Diagnostics of the fit of a path to the file's points.
struct PathFileDiagnostics {
  std::size_t points = 0;
  /// Number of points of the file that were left out because they repeat the previous point.
  std::size_t repeated_points = 0;
  PathFit fit = PathFit::kSpline;
  double deviation = 0.0;  ///< Largest deviation of the file's points from the fitted path [m].
  /// Station at which the file's points deviate most from the fitted path [m].
  double deviation_station = 0.0;
  /// Largest distance of the fitted spline from the straight lines between the points [m].
  double bulge = 0.0;
  /// Approximate station at which the spline is farthest from the straight lines between the points
  /// [m].
  double bulge_station = 0.0;
  /// Smoothing length of the fitted spline [m]; 0 if no spline was fitted.
  double smoothing_length = 0.0;
  /// Largest difference between the headings in the file and the headings of the fitted path [rad].
  double heading_difference = 0.0;
  std::size_t heading_jumps = 0;  ///< Number of corners, if the path is a polyline.
  /// Largest jump of the heading at a corner, if the path is a polyline [rad].
  double heading_jump_max = 0.0;
};
void Visit(DiagnosticsVisitor& out, const PathFileDiagnostics& own);
PathFileDiagnostics DiagnosticsOf(const FittedPath& fitted);

/// Describes the fit of a path to points in one line, for example "spline within 0.049 m of 120
/// points, smoothing length 3.1 m".
std::string Describe(const FittedPath& fitted);

/// Returns the remedy against a path that turns back on itself (FittedPath::reversals), worded as
/// the end of a message. The text `noise_key` names the option against noisy points; the remedy
/// adds a value for that option.
std::string ReversalRemedy(const FittedPath& fitted, const std::string& noise_key);

/// Returns the planner `path_file`. The plan follows the path in PathFileOptions from its first
/// point, forwards and in reverse, stops at the path's cusps, and ignores obstacles. If the path
/// begins in reverse, the car starts at rest unless the mission sets its speed. If the path is a
/// polyline with corners, the status of the plan is kTurnTooTight, unless the request allows
/// infeasible plans. If PathFileOptions contains no path, the status of the plan is kNoPath.
PlannerEntry PathFilePlanner();

}  // namespace trackbed

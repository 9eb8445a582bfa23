#pragma once

#include <functional>
#include <optional>
#include <string>

#include "src/planning/avoidance/avoidance_curve.h"
#include "src/planning/avoidance/curve_repair.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"

/// Finds, for a conflict with an obstacle, the stretch of the plan that a curve past the obstacle
/// replaces.
namespace trackbed::avoidance {

/// Distance between collision checks along a path [m].
inline constexpr double kPathCheckSpacing = 0.1;

/// A stretch of the plan on which an obstacle is too close to the car.
struct Conflict {
  double from = 0.0;  ///< Station at which the conflict begins [m].
  double to = 0.0;    ///< Station at which the conflict ends [m].
  OrientedBox obstacle;
};

/// Returns the first stretch after the station `from` on which an obstacle is closer to the car
/// than `safe_distance` [m].
std::optional<Conflict> FirstConflict(const AvoidanceRequest& request, double safe_distance,
                                      const Path& path, double from);

/// Returns the station at which the path runs beside the obstacle of a conflict.
double StationBeside(const Path& path, const VehicleParams& vehicle, const Conflict& conflict);

/// A curve, found by any method, that replaces the plan between two stations.
struct Replacement {
  Stations stations;  ///< Stations of the plan that the curve replaces [m].
  Pose2 start;        ///< Pose at the start of the curve.
  BezierCurve curve;
  CurveCheck check;
  double speed = 0.0;  ///< Speed limit on the curve [m/s].
  PassingSide passing_side = PassingSide::kInner;
  std::vector<TreeNode> tree;  ///< Nodes of the search tree whose path the curve follows.
  std::vector<std::string> notes;
  /// Function that makes the method's diagnostics from the new plan and the curve's stations on the
  /// new plan.
  std::function<MethodDiagnostics(const Plan& plan, const Stations& curve)> diagnostics;
};

struct ReplacementSearch {
  std::optional<Replacement> replacement;
  std::string why;  ///< reason why no curve was found, as a text for users
};

/// A feasible curve that replaces the plan between two stations.
struct Stretch {
  CurveProblem problem;
  Repair repair;
  PassingSide passing_side = PassingSide::kInner;
  double leave = 0.0;  ///< Station at which the curve leaves the plan [m].
  double back = 0.0;   ///< Station at which the curve returns to the plan [m].
  RrtStarResult tree;
  OrientedBox obstacle;
  double beside = 0.0;  ///< Station at which the plan runs beside the obstacle [m].
  int tried = 0;        ///< Number of curves that the search tried.
};

struct StretchSearch {
  std::optional<Stretch> stretch;
  std::string why;  ///< reason why no stretch was found, as a text for users
};

/// Finds the stretch of the plan that a curve replaces. The search prefers, in this order, a high
/// speed, the side with the shorter RRT* path, and an early return. The curve may leave the plan
/// only at the station `from` or later. The plan may already contain curves around other obstacles.
StretchSearch FindStretch(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                          const Plan& plan, const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

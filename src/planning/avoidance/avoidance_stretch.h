#pragma once

#include <functional>
#include <optional>
#include <string>

#include "src/planning/avoidance/avoidance_curve.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"

/// From a conflict with an obstacle to the stretch of the plan that a curve replaces.
namespace trackbed::avoidance {

/// Spacing of collision checks along a path [m].
inline constexpr double kPathCheckSpacing = 0.1;

/// A stretch of the plan on which an obstacle is too close.
struct Conflict {
  double from = 0.0;  ///< station [m]
  double to = 0.0;    ///< station [m]
  OrientedBox obstacle;
};

/// The first conflict beyond `from`: an obstacle is closer than `safe_distance` [m].
std::optional<Conflict> FirstConflict(const AvoidanceRequest& request, double safe_distance,
                                      const Path& path, double from);

/// The station at which the path runs beside the obstacle.
double StationBeside(const Path& path, const VehicleParams& vehicle, const Conflict& conflict);

/// A curve that replaces the plan between two stations, by any method.
struct Replacement {
  Stations stations;  ///< of the plan
  Pose2 start;        ///< of the curve
  BezierCurve curve;
  CurveCheck check;
  double speed = 0.0;  ///< limit on the curve [m/s]
  PassingSide passing_side = PassingSide::kInner;
  std::vector<TreeNode> tree;  ///< of the search for this curve
  std::vector<std::string> notes;
  /// Makes the method's diagnostics from the new plan and the curve's stations on it.
  std::function<MethodDiagnostics(const Plan& plan, const Stations& curve)> diagnostics;
};

struct ReplacementSearch {
  std::optional<Replacement> replacement;
  std::string why;  ///< why none was found, for people
};

/// A feasible curve that replaces the plan between two stations.
struct Stretch {
  CurveProblem problem;
  Repair repair;
  PassingSide passing_side = PassingSide::kInner;
  double leave = 0.0;  ///< station [m]
  double back = 0.0;   ///< station [m]
  RrtStarResult tree;
  OrientedBox obstacle;
  double beside = 0.0;  ///< station at which the plan runs beside the obstacle [m]
  int tried = 0;        ///< number of curves tried
};

struct StretchSearch {
  std::optional<Stretch> stretch;
  std::string why;  ///< why none was found, for people
};

/// Finds the stretch. Prefers, in this order: a high speed, the side with the shorter RRT* path,
/// and an early return to the plan. The car can leave the plan, which may already contain curves
/// around other obstacles, at `from` or later.
StretchSearch FindStretch(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                          const Plan& plan, const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

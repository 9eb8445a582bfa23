#pragma once

#include <functional>
#include <optional>
#include <string>

#include "src/planning/avoidance/avoidance_curve.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"

/// From an obstacle that stands in the way to the stretch of the plan that a curve replaces.
namespace trackbed::avoidance {

/// Between the points at which a path is held against obstacles [m].
inline constexpr double kLook = 0.1;

/// A stretch of the plan on which an obstacle is too close.
struct Conflict {
  double from = 0.0;  ///< station [m]
  double to = 0.0;    ///< station [m]
  OrientedBox obstacle;
};

/// The first one beyond `from` on which an obstacle is closer than `safe_distance` [m].
std::optional<Conflict> FirstConflict(const AvoidanceRequest& request, double safe_distance,
                                      const Path& path, double from);

/// The station at which the path runs beside the obstacle.
double StationBeside(const Path& path, const VehicleParams& vehicle, const Conflict& conflict);

/// A curve in place of the plan between two of its stations, whatever method it is from.
struct Replacement {
  Stations stations;  ///< of the plan
  Pose2 start;        ///< of the curve
  BezierCurve curve;
  CurveCheck check;
  double speed = 0.0;  ///< at most, on the curve [m/s]
  PassingSide passing_side = PassingSide::kInner;
  std::vector<TreeNode> tree;  ///< that was searched for it
  std::vector<std::string> notes;
  /// Of the method, given the new plan and the curve's stations on it.
  std::function<MethodDiagnostics(const Plan& plan, const Stations& curve)> diagnostics;
};

struct ReplacementSearch {
  std::optional<Replacement> replacement;
  std::string why;  ///< there is none, for people
};

/// A curve that can be driven in place of the plan between two stations.
struct Stretch {
  CurveProblem problem;
  Repair repair;
  PassingSide passing_side = PassingSide::kInner;
  double leave = 0.0;  ///< station [m]
  double back = 0.0;   ///< station [m]
  RrtStarResult tree;
  OrientedBox obstacle;
  double beside = 0.0;  ///< station at which the plan runs beside the obstacle [m]
  int tried = 0;        ///< curves
};

struct StretchSearch {
  std::optional<Stretch> stretch;
  std::string why;  ///< there is none, for people
};

/// Looks for the stretch, first on the side that RRT* prefers, at full speed, back on the plan as
/// early as can be; then on the other side, then more slowly. `from` is where the plan, which may
/// have been led around other obstacles already, can be left.
StretchSearch FindStretch(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                          const Plan& plan, const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

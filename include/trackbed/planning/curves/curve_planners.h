#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/planner.h"

/// Planners that join poses by the shortest possible curves.
namespace trackbed {

/// How the curvature of a path of curves may change.
enum class CurveCurvature {
  /// The curvature is continuous, except at cusps, if the car can drive such a path; otherwise, the
  /// curvature steps. A note of the plan says why the curvature steps.
  kAuto,
  /// The curvature steps between straights and arcs, which the car passes slowly enough for its
  /// steering.
  kSteps,
  kContinuous,  ///< The curvature is continuous, also at cusps (continuous_curvature.h).
  kCuspSteps,   ///< The curvature only steps at cusps, where the car turns its wheels at rest.
};

/// Quantity that a planner of curves of continuous curvature minimizes.
enum class CurveObjective {
  kLength,  ///< Length of the path, which the car drives at the mission's speed.
  kTime,    ///< Driving time; the car may drive more slowly on sharper turns.
};

/// Options of the planner `dubins`, which joins the stops of a route by Dubins curves (dubins.h).
struct DubinsOptions {
  /// Radius of every arc [m]; none: 1.1 times the car's smallest turning radius.
  std::optional<double> radius;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  /// Lowest speed of the car at a step of curvature, or on turns of continuous curvature [m/s].
  double min_speed = 0.3;
  /// How the curvature may change: kAuto, kSteps or kContinuous.
  CurveCurvature curvature = CurveCurvature::kAuto;
  /// Largest lateral acceleration on curves of continuous curvature [m/s^2], > 0; half of the
  /// tyres' grip is another limit.
  double max_lateral_acceleration = 3.0;
  /// Fraction of the car's steering rate that curves of continuous curvature use, in (0, 1].
  double max_steering_rate_fraction = 0.9;
  CurveObjective objective =
      CurveObjective::kTime;  ///< Quantity to minimize, for curves of continuous curvature.
};
void Visit(KeyVisitor& keys, DubinsOptions& options);

/// Options of the planner `reeds_shepp` (reeds_shepp.h). Each option has the same meaning as for
/// the planner `dubins`.
struct ReedsSheppOptions {
  std::optional<double> radius;
  double safe_distance = 0.3;
  double min_speed = 0.3;
  CurveCurvature curvature = CurveCurvature::kAuto;
  double max_lateral_acceleration = 3.0;
  double max_steering_rate_fraction = 0.9;
  CurveObjective objective = CurveObjective::kTime;
};
void Visit(KeyVisitor& keys, ReedsSheppOptions& options);

/// Diagnostics of the curve from one stop to the next.
struct CurveFindings {
  std::string word;     ///< Word that describes the curve, such as "L+S+R+".
  double length = 0.0;  ///< Length of the curve [m].
  double radius = 0.0;  ///< Radius of the curve's arcs [m].
  /// Number of shorter curves that were rejected because of obstacles or the car's initial motion.
  std::ptrdiff_t shorter_ones_blocked = 0;
};
void Visit(DiagnosticsVisitor& out, const CurveFindings& own);

/// Diagnostics of the planners `dubins` and `reeds_shepp`.
struct CurveDiagnostics {
  std::vector<CurveFindings> curves;
};
void Visit(DiagnosticsVisitor& out, const CurveDiagnostics& own);

PlannerEntry DubinsPlanner();
PlannerEntry ReedsSheppPlanner();

}  // namespace trackbed

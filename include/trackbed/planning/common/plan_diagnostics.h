#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/open_loop.h"
#include "trackbed/planning/common/speed_at_limit.h"

namespace trackbed {

struct Plan;

/// The side on which a path passes an obstacle: the inner side is toward the center of the turn,
/// the outer side away from the center. On a straight, the inner side is the left side.
enum class PassingSide { kInner, kOuter };

/// Returns "inner" or "outer".
const char* ToString(PassingSide passing_side);

/// A stretch of the path that a local planner replaced to pass an obstacle.
struct AvoidedStretch {
  MethodDiagnostics method;  ///< Diagnostics of the local planner.
  Vec2 obstacle{0.0, 0.0};   ///< Center of the obstacle [m].
  PassingSide passing_side = PassingSide::kInner;
  Stations stations;    ///< Stations of the new stretch [m].
  double speed = 0.0;   ///< Speed limit on the stretch [m/s].
  double length = 0.0;  ///< Length of the stretch [m].
  /// Smallest distance of the car's footprint from known obstacles [m].
  double clearance = 0.0;
  double steering_max = 0.0;              ///< Largest steering angle of the bicycle model [rad].
  double steering_rate_max = 0.0;         ///< Largest steering rate at `speed` [rad/s].
  double lateral_acceleration_max = 0.0;  ///< Largest lateral acceleration at `speed` [m/s^2].
  std::vector<Vec2> control_points;       ///< Control points of the Bezier curve [m].
  /// Errors of the kinematic car at the end of the stretch, if it drives the stretch open loop.
  double end_distance = 0.0;       ///< Distance of the car from the end of the stretch [m].
  double end_heading_error = 0.0;  ///< Heading of the car minus heading of the path [rad].
};
void Visit(DiagnosticsVisitor& out, const AvoidedStretch& stretch);

/// Describes how a plan was found, and how a car would drive the plan open loop. Diagnostics are
/// not needed to drive the plan.
struct PlanDiagnostics {
  MethodDiagnostics planner;  ///< Diagnostics of the planner, such as RrtDiagnostics.
  /// Diagnostics of the turns of an open-loop schedule: FilletTurnFindings.
  std::vector<MethodDiagnostics> turns;
  std::optional<std::vector<RoundCorner>> corners;  ///< Rounded corners.
  std::optional<std::size_t> direction_changes;     ///< Number of cusps on the path.
  /// Distance D_end at which the car stops in an open-loop run [m]; none: not planned.
  std::optional<double> stop_distance;
  std::optional<OpenLoopRun> open_loop;  ///< Simulated open-loop run of the kinematic car.
  std::vector<AvoidedStretch> avoided;   ///< Stretches that were replaced to pass obstacles.
  /// Findings on the plan's speeds, if the plan has speeds at the car's limit.
  std::optional<LimitProfileFindings> speed_profile;
  MethodDiagnostics replan;  ///< ReplanDiagnostics of a plan made during the run.
  long samples = 0;          ///< Number of random samples drawn in all trees.
};

/// Visits the fields of a plan's diagnostics.
void Visit(DiagnosticsVisitor& out, const Plan& plan);

/// Returns the diagnostics in the format of plan.json.
nlohmann::json DiagnosticsJson(const Plan& plan);

}  // namespace trackbed

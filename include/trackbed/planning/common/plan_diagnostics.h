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

/// The side on which a path passes an obstacle: toward the center of the turn, or away from it. On
/// a straight, inner means left.
enum class PassingSide { kInner, kOuter };

/// "inner" or "outer".
const char* ToString(PassingSide passing_side);

/// A stretch of the path that a local planner replaced to pass an obstacle.
struct AvoidedStretch {
  MethodDiagnostics method;  ///< of the local planner
  Vec2 obstacle{0.0, 0.0};   ///< its center [m]
  PassingSide passing_side = PassingSide::kInner;
  Stations stations;               ///< of the new path [m]
  double speed = 0.0;              ///< limit [m/s]
  double length = 0.0;             ///< [m]
  double clearance = 0.0;          ///< smallest, of the car's footprint from known obstacles [m]
  double steering_max = 0.0;       ///< largest bicycle angle [rad]
  double steering_rate_max = 0.0;  ///< at `speed` [rad/s]
  double lateral_acceleration_max = 0.0;  ///< at `speed` [m/s^2]
  std::vector<Vec2> control_points;       ///< of the Bezier curve [m]
  /// Errors at the end of the stretch, for the kinematic car that drives it open loop.
  double end_distance = 0.0;       ///< from the path's point [m]
  double end_heading_error = 0.0;  ///< heading of the car minus that of the path [rad]
};
void Visit(DiagnosticsVisitor& out, const AvoidedStretch& stretch);

/// How a plan was found, and what it requires of an open-loop run. Not needed to drive it.
struct PlanDiagnostics {
  MethodDiagnostics planner;             ///< of the planner, such as RrtDiagnostics
  std::vector<MethodDiagnostics> turns;  ///< with an open-loop schedule: FilletTurnFindings
  std::optional<std::vector<RoundCorner>> corners;    ///< rounded corners
  std::optional<std::size_t> direction_changes;       ///< cusps on the path
  std::optional<double> stop_distance;                ///< D_end, if the schedule has one [m]
  std::optional<OpenLoopRun> open_loop;               ///< of the schedule, by the kinematic car
  std::vector<AvoidedStretch> avoided;                ///< stretches replaced to pass obstacles
  std::optional<LimitProfileFindings> speed_profile;  ///< if speeds are at the limit
  MethodDiagnostics replan;  ///< ReplanDiagnostics of a plan made during the run
  long samples = 0;          ///< random samples drawn, of all trees
};

/// Visits the fields of a plan's diagnostics.
void Visit(DiagnosticsVisitor& out, const Plan& plan);

/// The diagnostics in the format of plan.json.
nlohmann::json DiagnosticsJson(const Plan& plan);

}  // namespace trackbed

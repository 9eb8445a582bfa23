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
struct PlannedWait;

/// The side on which a path passes an obstacle: the inner side is the side toward the center of the
/// turn, the outer side is the opposite side. On a straight path, the inner side of an obstacle is
/// the left side.
enum class PassingSide { kInner, kOuter };

/// Returns the name of a passing side: "inner" or "outer".
const char* ToString(PassingSide passing_side);

/// A stretch of the path that a local planner replaced to pass an obstacle.
struct AvoidedStretch {
  /// Diagnostics of the local planner that replaced the stretch of the path.
  MethodDiagnostics method;
  Vec2 obstacle{0.0, 0.0};  ///< Center of the passed obstacle [m].
  PassingSide passing_side = PassingSide::kInner;
  Stations stations;    ///< Stations of the new stretch of the path [m].
  double speed = 0.0;   ///< Speed limit on the new stretch of the path [m/s].
  double length = 0.0;  ///< Length of the new stretch of the path [m].
  /// Smallest distance of the car's footprint from the known obstacles on the new stretch of the
  /// path [m].
  double clearance = 0.0;
  /// Largest steering angle of the bicycle model on the new stretch of the path [rad].
  double steering_max = 0.0;
  /// Largest steering rate on the new stretch of the path at its speed limit [rad/s].
  double steering_rate_max = 0.0;
  /// Largest lateral acceleration on the new stretch of the path at its speed limit [m/s^2].
  double lateral_acceleration_max = 0.0;
  /// Control points of the Bezier curve that replaces the stretch of the path [m].
  std::vector<Vec2> control_points;
  /// Distance of a simulated kinematic car, which drives the new stretch of the path open loop,
  /// from the end of the stretch [m].
  double end_distance = 0.0;
  /// Heading of the simulated kinematic car minus heading of the path, at the end of the new
  /// stretch [rad].
  double end_heading_error = 0.0;
};
void Visit(DiagnosticsVisitor& out, const AvoidedStretch& stretch);

/// Describes how a plan was found, and how a car would drive the plan open loop. Driving a plan
/// does not require its diagnostics.
struct PlanDiagnostics {
  MethodDiagnostics planner;  ///< Diagnostics of the planner, such as RrtDiagnostics.
  /// Diagnostics of the turns of an open-loop steering schedule (FilletTurnFindings).
  std::vector<MethodDiagnostics> turns;
  /// Corners of a polyline that the planner rounded.
  std::optional<std::vector<RoundCorner>> corners;
  std::optional<std::size_t> direction_changes;  ///< Number of cusps on the path.
  /// Driven distance D_end at which the car stops in an open-loop run [m]; none if not planned.
  std::optional<double> stop_distance;
  /// Simulated open-loop run of a kinematic car on the plan.
  std::optional<OpenLoopRun> open_loop;
  /// Stretches of the path that were replaced to pass obstacles.
  std::vector<AvoidedStretch> avoided;
  /// Diagnostics of the planned speeds, if the plan has speeds at the car's limit.
  std::optional<LimitProfileFindings> speed_profile;
  MethodDiagnostics replan;  ///< ReplanDiagnostics, if the plan was made during a run.
  long samples = 0;  ///< Number of random samples that the planner drew for all search trees.
};

void Visit(DiagnosticsVisitor& out, const PlannedWait& wait);

/// Visits the fields of a plan's diagnostics.
void Visit(DiagnosticsVisitor& out, const Plan& plan);

/// Returns the diagnostics in the format of plan.json.
nlohmann::json DiagnosticsJson(const Plan& plan);

}  // namespace trackbed

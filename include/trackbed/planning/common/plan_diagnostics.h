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
/// turn, the outer side is the opposite side. On a straight, the inner side is the left side.
enum class PassingSide { kInner, kOuter };

/// Returns the name of a passing side: "inner" or "outer".
const char* ToString(PassingSide passing_side);

/// A stretch of the path that a local planner replaced to pass an obstacle.
struct AvoidedStretch {
  MethodDiagnostics method;  ///< Diagnostics of the local planner that replaced the stretch.
  Vec2 obstacle{0.0, 0.0};   ///< Center of the passed obstacle [m].
  PassingSide passing_side = PassingSide::kInner;
  Stations stations;    ///< Stations of the new stretch [m].
  double speed = 0.0;   ///< Speed limit on the new stretch [m/s].
  double length = 0.0;  ///< Length of the new stretch [m].
  /// Smallest distance of the car's footprint from the known obstacles on the new stretch [m].
  double clearance = 0.0;
  /// Largest steering angle of the bicycle model on the new stretch [rad].
  double steering_max = 0.0;
  double steering_rate_max = 0.0;  ///< Largest steering rate on the new stretch at `speed` [rad/s].
  /// Largest lateral acceleration on the new stretch at `speed` [m/s^2].
  double lateral_acceleration_max = 0.0;
  std::vector<Vec2> control_points;  ///< Control points of the new stretch's Bezier curve [m].
  /// Errors of a simulated kinematic car at the end of the stretch, after the car has driven the
  /// stretch open loop.
  double end_distance = 0.0;  ///< Distance of the simulated car from the end of the stretch [m].
  /// Heading of the simulated car minus heading of the path [rad].
  double end_heading_error = 0.0;
};
void Visit(DiagnosticsVisitor& out, const AvoidedStretch& stretch);

/// Describes how a plan was found, and how a car would drive the plan open loop. The plan can be
/// driven without these diagnostics.
struct PlanDiagnostics {
  MethodDiagnostics planner;  ///< Diagnostics of the planner, such as RrtDiagnostics.
  /// Diagnostics of the turns of an open-loop schedule (FilletTurnFindings).
  std::vector<MethodDiagnostics> turns;
  /// Corners of a polyline that the planner rounded.
  std::optional<std::vector<RoundCorner>> corners;
  std::optional<std::size_t> direction_changes;  ///< Number of cusps on the path.
  /// Driven distance D_end at which the car stops in an open-loop run [m]; none if not planned.
  std::optional<double> stop_distance;
  std::optional<OpenLoopRun> open_loop;  ///< Simulated open-loop run of the kinematic car.
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

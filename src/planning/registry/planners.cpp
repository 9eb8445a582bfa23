#include "trackbed/planning/registry/planners.h"

#include <fmt/format.h>

#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/options/registry.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/open_loop.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/waypoint_miss.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/course/lane_change.h"
#include "trackbed/planning/course/straight.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/fillet/fillet_planner.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar_planner.h"
#include "trackbed/planning/lanes/lane_route_planner.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/racing/center_line.h"
#include "trackbed/planning/racing/minimum_curvature.h"
#include "trackbed/planning/racing/minimum_time.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

namespace trackbed {
namespace {

/// Returns the registry of planners, a table with one line per planner.
Registry<PlannerEntry>& RegisteredPlanners() {
  static Registry<PlannerEntry> table("planner", {
                                                     FilletPlanner(),
                                                     LaneChangePlanner(),
                                                     CoursePlanner(),
                                                     LaneRoutePlanner(),
                                                     DubinsPlanner(),
                                                     ReedsSheppPlanner(),
                                                     AStarPlanner(),
                                                     HybridAStarPlanner(),
                                                     RrtPlanner(),
                                                     RrtStarPlanner(),
                                                     PathFilePlanner(),
                                                     CenterLinePlanner(),
                                                     MinimumCurvaturePlanner(),
                                                     MinimumTimePlanner(),
                                                     StraightPlanner(),
                                                 });
  return table;
}

void CheckVehicle(const VehicleParams& vehicle) {
  for (const double number :
       {vehicle.wheelbase, vehicle.length, vehicle.width, vehicle.rear_overhang,
        vehicle.steering_limit, vehicle.steering_rate, vehicle.friction_longitudinal,
        vehicle.friction_lateral, vehicle.max_deceleration, vehicle.max_acceleration,
        vehicle.top_speed}) {
    TRACKBED_CHECK(std::isfinite(number), "vehicle {}: a parameter is {}", vehicle.name, number);
  }
}

void CheckBox(const char* what, const OrientedBox& box) {
  TRACKBED_CHECK(box.center.position().allFinite() && std::isfinite(box.center.yaw) &&
                     std::isfinite(box.length) && std::isfinite(box.width),
                 "{} of {} x {} m at {}, {}, yaw {}", what, box.length, box.width, box.center.x,
                 box.center.y, box.center.yaw);
}

void CheckWorld(const PlanRequest& request) {
  for (const OrientedBox& box : request.obstacles) {
    CheckBox("obstacle", box);
  }
  TRACKBED_CHECK(std::isfinite(request.friction), "friction {}", request.friction);
  for (const FrictionPatch& patch : request.friction_patches) {
    CheckBox("friction patch", patch.area);
    TRACKBED_CHECK(std::isfinite(patch.friction), "friction {}", patch.friction);
  }
  TRACKBED_CHECK(request.wind.velocity.allFinite(), "wind {}, {}", request.wind.velocity.x(),
                 request.wind.velocity.y());
}

void CheckRequest(const PlanRequest& request) {
  const SpeedLimits& speed = request.speed;
  TRACKBED_CHECK(std::isfinite(request.start_speed) && std::isfinite(speed.speed) &&
                     std::isfinite(request.start_steering) && std::isfinite(speed.acceleration) &&
                     std::isfinite(speed.deceleration) && speed.speed > 0.0 &&
                     speed.acceleration > 0.0 && speed.deceleration > 0.0,
                 "start speed {}, speed {}, acceleration {}, deceleration {}", request.start_speed,
                 speed.speed, speed.acceleration, speed.deceleration);
  const Pose2& start = request.start;
  TRACKBED_CHECK(std::isfinite(start.x) && std::isfinite(start.y) && std::isfinite(start.yaw),
                 "start at {}, {}, {}", start.x, start.y, start.yaw);
  for (const Vec2& point : request.waypoints) {
    TRACKBED_CHECK(point.allFinite(), "waypoint {}, {}", point.x(), point.y());
  }
  TRACKBED_CHECK(request.headings.empty() || request.headings.size() == request.waypoints.size(),
                 "{} headings for {} waypoints", request.headings.size(), request.waypoints.size());
  TRACKBED_CHECK(request.max_waypoint_miss.value_or(0.0) >= 0.0, "max_waypoint_miss {}",
                 *request.max_waypoint_miss);
  for (const double heading : request.headings) {
    TRACKBED_CHECK(std::isfinite(heading), "heading {}", heading);
  }
  TRACKBED_CHECK(request.on_track.laps >= 1, "{} laps", request.on_track.laps);
  CheckVehicle(request.vehicle);
  CheckWorld(request);
}

/// Returns the plan, or a rejected plan if the path passes a waypoint farther away than the request
/// allows. A partial plan says itself which waypoints it does not reach.
Plan KeepToWaypoints(Plan plan, const PlanRequest& request) {
  plan.waypoints = request.waypoints;
  if (!plan.ok() || !plan.partial.empty() || !request.max_waypoint_miss) {
    return plan;
  }
  const double bound = *request.max_waypoint_miss;
  const auto miss = LargestWaypointMiss(plan.reference.path, plan.waypoints);
  if (!miss || miss->distance <= bound + kSameMiss) {
    return plan;
  }
  Plan refused;
  refused.status = PlanStatus::kWaypointMissed;
  refused.reason = fmt::format("{} is missed by {:.4g} m, more than {:.4g} m; {}",
                               DescribeWaypoint(miss->waypoint, miss->at), miss->distance, bound,
                               RemedyForMiss(miss->distance));
  refused.diagnostics = std::move(plan.diagnostics);
  return refused;
}

}  // namespace

const std::vector<PlannerEntry>& Planners() {
  return RegisteredPlanners().entries();
}

void RegisterPlanner(PlannerEntry entry) {
  RegisteredPlanners().Add(std::move(entry));
}

const PlannerEntry& PlannerFor(const PlannerOptions& options) {
  return RegisteredPlanners().For(options);
}

bool MayGoBackwards(const PlannerOptions& options) {
  const PlannerEntry& entry = PlannerFor(options);
  return entry.may_go_backwards != nullptr ? entry.may_go_backwards(options) : entry.goes_backwards;
}

bool MayBePartial(const PlannerOptions& options) {
  const PlannerEntry& entry = PlannerFor(options);
  return entry.may_be_partial != nullptr && entry.may_be_partial(options);
}

std::optional<double> PlannerSafeDistance(const PlannerOptions& options) {
  PlannerOptions own = options;
  return FindNumber("safe_distance", [&](KeyVisitor& keys) { Visit(keys, own); });
}

FeasiblePlan MakePlan(const PlanRequest& request, const PlannerOptions& options) {
  CheckRequest(request);
  PlannerOptions own = options;
  RequireInRange("MakePlan", [&](KeyVisitor& keys) { Visit(keys, own); });
  FeasiblePlan plan =
      MakeFeasible(KeepToWaypoints(PlannerFor(options).plan(request, options), request), request,
                   Refusal::kExplained);
  if (plan.ok() && !plan->diagnostics.open_loop) {
    plan.diagnostics().open_loop =
        SimulateOpenLoop(request.vehicle, plan->reference.path, plan->schedule,
                         plan->schedule_speed.knots().back().s);
  }
  return plan;
}

}  // namespace trackbed

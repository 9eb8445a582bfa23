#include "trackbed/planning/planner.h"

#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using nlohmann::json;

json Point(const Vec2& p) {
  return json::array({p.x(), p.y()});
}

const char* ActiveConstraint(const FilletOptions& options, const FilletTurn& turn) {
  if (options.radius) {
    return "given";
  }
  if (turn.radius >= options.max_radius) {
    return "max_radius";
  }
  return options.constraint == RadiusConstraint::kHalfLeg ? "half_leg" : "steering_room";
}

json ToJson(const FilletOptions& options, const FilletTurn& turn) {
  return {{"waypoint", turn.waypoint},
          {"heading_change_rad", turn.heading_change},
          {"interior_angle_rad", turn.interior_angle},
          {"radius_m", turn.radius},
          {"active_constraint", ActiveConstraint(options, turn)},
          {"centre_m", Point(turn.centre)},
          {"arc_start_m", Point(turn.arc_start)},
          {"arc_end_m", Point(turn.arc_end)},
          {"arc_start_s_m", turn.arc_start_s},
          {"arc_length_m", turn.arc_length},
          {"tangent_length_m", turn.tangent_length},
          {"steering_rad", turn.steering},
          {"ramp_time_s", turn.ramp_time},
          {"ramp_distance_m", turn.ramp_distance},
          {"steer_start_m", turn.steer_start},
          {"steer_return_m", turn.steer_return},
          {"ramp_truncated", turn.ramp_truncated}};
}

Plan PlanWith(const FilletOptions& options, const PlanRequest& request) {
  const FilletPlan fillets =
      PlanFillets(request.vehicle, request.waypoints, request.speed.speed, options);
  Plan plan;
  plan.status = fillets.status;
  plan.reason = fillets.reason;
  if (!plan.ok()) {
    plan.diagnostics["waypoint"] = fillets.waypoint;
    return plan;
  }
  plan.reference.path = fillets.path;
  plan.schedule = fillets.schedule;
  plan.diagnostics["turns"] = json::array();
  for (const FilletTurn& turn : fillets.turns) {
    plan.diagnostics["turns"].push_back(ToJson(options, turn));
  }
  return plan;
}

}  // namespace

const std::vector<PlannerEntry>& Planners() {
  static const std::vector<PlannerEntry> table{
      {"fillet", "straight legs and arcs of the largest radius the steering rate allows (C.1-C.40)",
       FilletOptions{}},
  };
  return table;
}

const char* PlannerName(const PlannerOptions& options) {
  for (const PlannerEntry& entry : Planners()) {
    if (entry.defaults.index() == options.index()) {
      return entry.name;
    }
  }
  throw InternalError("options of a planner that is not in the table");
}

Plan MakePlan(const PlanRequest& request, const PlannerOptions& options) {
  const SpeedLimits& speed = request.speed;
  TRACKBED_CHECK(std::isfinite(request.start_speed) && std::isfinite(speed.speed) &&
                     std::isfinite(speed.acceleration) && std::isfinite(speed.deceleration) &&
                     speed.speed > 0.0 && speed.acceleration > 0.0 && speed.deceleration > 0.0,
                 "start speed {}, speed {}, acceleration {}, deceleration {}", request.start_speed,
                 speed.speed, speed.acceleration, speed.deceleration);
  Plan plan = std::visit([&](const auto& own) { return PlanWith(own, request); }, options);
  if (plan.ok()) {
    plan.reference.speed =
        StopAtEnd(plan.reference.path.length(), request.start_speed, request.speed);
  }
  return plan;
}

}  // namespace trackbed

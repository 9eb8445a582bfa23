#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/planning/fillet/fillet_layout.h"
#include "trackbed/planning/fillet/fillet.h"

namespace trackbed {
namespace {

using nlohmann::json;

json Point(const Vec2& p) {
  return json::array({p.x(), p.y()});
}

/// A search whose every `stride`-th variable is a radius.
json ToJson(const SearchOptions& options, const SearchResult& result, std::size_t stride) {
  json out{{"method", SearchFor(options.method).name},
           {"status", ToString(result.status)},
           {"evaluations", result.evaluations},
           {"objective", result.value},
           {"history", json::array()}};
  for (const SearchProgress& progress : result.history) {
    json radii = json::array();
    for (std::size_t i = 0; i + stride <= progress.x.size(); i += stride) {
      radii.push_back(progress.x[i]);
    }
    out["history"].push_back({{"evaluations", progress.evaluations},
                              {"objective", progress.value},
                              {"radius_m", radii}});
  }
  return out;
}

json ToJson(const FilletOptions& options, const TurnSearch& search) {
  json out = ToJson(options.search, search.result, 1);
  out["first_radius_m"] = search.first_radius;
  out["window_time_s"] = search.time;
  out["window_heading_rad"] = search.heading;
  // JSON knows no infinity: a car that did not turn in its window has no such radius.
  out["free_radius_m"] =
      std::isfinite(search.free_radius) ? json(search.free_radius) : json(nullptr);
  return out;
}

json ToJson(const FilletOptions& options, const FilletTurn& turn) {
  json out{{"waypoint", turn.waypoint},
           {"heading_change_rad", turn.heading_change},
           {"interior_angle_rad", turn.interior_angle},
           {"radius_m", turn.radius},
           {"speed_mps", turn.speed},
           {"active_constraint", ToString(turn.active)},
           {"center_m", Point(turn.center)},
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
  if (!turn.note.empty()) {
    out["note"] = turn.note;
  }
  if (turn.search) {
    out["search"] = ToJson(options, *turn.search);
  }
  return out;
}

/// Where the wheels of a turn are straight again.
double ReturnEnd(const FilletTurn& turn) {
  return turn.steer_return + turn.ramp_distance;
}

std::vector<IsolatedTurn> IsolatedTurnsOf(const FilletPlan& plan) {
  std::vector<IsolatedTurn> lone;
  double straight_from = 0.0;
  for (const FilletTurn& turn : plan.turns) {
    const bool alone = turn.steer_start >= straight_from && turn.neutral == 0.0;
    straight_from = ReturnEnd(turn);
    const double middle = turn.arc_start_s + 0.5 * turn.arc_length;
    if (alone && !turn.ramp_truncated && turn.steer_start + turn.ramp_distance <= middle) {
      lone.push_back({turn.waypoint, turn.steer_start, middle, turn.steering, turn.speed});
    }
  }
  return lone;
}

/// A turn is slow from where its wheels begin to turn to where they are straight again.
std::vector<SpeedCap> CapsOf(const FilletPlan& plan, double speed) {
  std::vector<SpeedCap> caps;
  for (const FilletTurn& turn : plan.turns) {
    if (turn.speed < speed) {
      caps.push_back({turn.steer_start, ReturnEnd(turn), turn.speed});
    }
  }
  return caps;
}

Plan PlanWith(const FilletOptions& options, const PlanRequest& request) {
  const FilletPlan fillets =
      PlanFillets(request.vehicle, request.waypoints, request.speed.speed, options, request.seed);
  Plan plan;
  plan.status = fillets.status;
  plan.reason = fillets.reason;
  if (!plan.ok()) {
    plan.diagnostics["waypoint"] = fillets.waypoint;
    return plan;
  }
  plan.reference.path = fillets.path;
  plan.schedule = fillets.schedule;
  plan.turns = IsolatedTurnsOf(fillets);
  plan.caps = CapsOf(fillets, request.speed.speed);
  plan.goal = fillets.path.At(fillets.path.length()).pose;
  plan.reference.speed =
      StopAtEnd(fillets.path.length(), request.start_speed, request.speed, plan.caps);
  plan.schedule_speed =
      StopAtEnd(fillets.stop_distance, request.start_speed, request.speed, plan.caps);

  json& out = plan.diagnostics;
  if (options.neutral_steering != 0.0) {
    out["neutral_steering_rad"] = options.neutral_steering;
    out["neutral_curvature_radpm"] =
        CurvatureForSteering(request.vehicle, options.neutral_steering);
  }
  out["turns"] = json::array();
  for (const FilletTurn& turn : fillets.turns) {
    out["turns"].push_back(ToJson(options, turn));
  }
  for (const IsolatedTurn& turn : plan.turns) {
    const TurnError error = PredictTurn(request.vehicle, fillets.path, turn, 0.0);
    for (json& entry : out["turns"]) {
      if (entry["waypoint"] == turn.waypoint) {
        entry["predicted"] = {{"heading_deficit_rad", error.heading_deficit},
                              {"lateral_offset_m", error.lateral_offset}};
      }
    }
  }
  out["stop_distance_m"] = fillets.stop_distance;
  out["open_loop"] = ToJson(fillets.verification);
  if (fillets.search) {
    out["search"] = ToJson(options.search, *fillets.search, fillet::kDrivenVariables);
  }
  return plan;
}

}  // namespace

void Visit(KeyVisitor& keys, DrivenWeights& weights) {
  keys.Field(
      {"position", "1/m^3", "weight of the squared path deviation, integrated over the length"},
      weights.position, Need::kOptional, kNonNegative);
  keys.Field({"heading", "1/m", "weight of the squared heading error, integrated over the length"},
             weights.heading, Need::kOptional, kNonNegative);
  keys.Field({"end", "1/m^2", "weight of the squared distance to the goal at the end"}, weights.end,
             Need::kOptional, kNonNegative);
}

void Visit(KeyVisitor& keys, FilletOptions& options) {
  keys.Field(
      {"radius", "m", "radius of all turns; default: the largest that the constraint allows"},
      options.radius, kPositive);
  static const EnumNames<RadiusConstraint> constraints{
      {RadiusConstraint::kSteeringRoom, "steering_room"},
      {RadiusConstraint::kHalfLeg, "half_leg"},
      {RadiusConstraint::kNone, "none"}};
  keys.Field({"constraint", "",
              "constraint on the radius: leaves room for the steering ramps (C.40), fits half the "
              "shorter leg (C.34), or none"},
             options.constraint, Need::kOptional, constraints);
  keys.Field({"neutral_steering", "rad",
              "steering angle between turns, positive to the left; unless 0, a kinematic car "
              "leaves the straight legs"},
             options.neutral_steering, Need::kOptional, kSteering);
  keys.Field({"max_radius", "m", "upper bound of the radius"}, options.max_radius, Need::kOptional,
             kPositive);
  static const EnumNames<InfeasibleTurnPolicy> without_room{
      {InfeasibleTurnPolicy::kSlowDown, "slow_down"},
      {InfeasibleTurnPolicy::kHalfLeg, "half_leg"},
      {InfeasibleTurnPolicy::kRefuse, "refuse"}};
  keys.Field({"without_room", "", "handling of turns for which C.40 has no feasible radius"},
             options.without_room, Need::kOptional, without_room);
  keys.Field({"min_speed", "m/s", "minimum speed in turns"}, options.min_speed, Need::kOptional,
             kPositive);
  static const EnumNames<RadiusObjective> objectives{{RadiusObjective::kLargest, "largest"},
                                                     {RadiusObjective::kLiteral, "literal"},
                                                     {RadiusObjective::kTurnLocal, "turn_local"},
                                                     {RadiusObjective::kDriven, "driven"}};
  keys.Field({"objective", "",
              "criterion for the radii: largest radius, yaw rate over a window of the route or "
              "over the turn, or tracking error of the simulated car"},
             options.objective, Need::kOptional, objectives);
  keys.Section({"search", "", "optimizer of the objective; not for 'largest'"}, options.search);
  keys.Field(
      {"resimulate_each_turn", "", "simulate the reference run before each turn, instead of once"},
      options.resimulate_each_turn, Need::kOptional);
  static const EnumNames<ReferencePoint> references{
      {ReferencePoint::kRearAxle, "rear_axle"},
      {ReferencePoint::kCenterOfGravity, "center_of_gravity"}};
  keys.Field({"reference", "", "point of the car that follows the path in the reference run"},
             options.reference, Need::kOptional, references);
  keys.Section({"weights", "", "weights of the objective 'driven'"}, options.weights);
}

PlannerEntry FilletPlanner() {
  return {.name = "fillet",
          .summary =
              "straight legs joined by arcs of the largest radius that the steering rate allows "
              "(C.1-C.40)",
          .defaults = FilletOptions{},
          .plan = PlanBy<FilletOptions, PlanWith>,
          .min_waypoints = kMinFilletWaypoints};
}

}  // namespace trackbed

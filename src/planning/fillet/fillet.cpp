#include "trackbed/planning/fillet/fillet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/planning/fillet/fillet_driven.h"
#include "src/planning/fillet/fillet_layout.h"
#include "src/planning/fillet/fillet_radius.h"
#include "src/planning/fillet/fillet_search.h"
#include "src/planning/fillet/fillet_waypoints.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using fillet::RadiusLimits;
using fillet::Refusal;
using fillet::Route;

FilletPlan PlanRoute(const VehicleParams& vehicle, const Route& route, double speed,
                     const FilletOptions& options, std::uint64_t seed) {
  std::vector<FilletTurn> turns = fillet::FindTurns(route);
  fillet::CheckMisses(vehicle, speed, options, turns);
  std::vector<RadiusLimits> limits;
  for (FilletTurn& turn : turns) {
    limits.push_back(fillet::LimitRadius(vehicle, speed, options, turn));
    turn.radius = limits.back().radii.high;
  }
  const bool two_passes = options.objective == RadiusObjective::kLiteral ||
                          options.objective == RadiusObjective::kTurnLocal;
  if (two_passes && !options.radius) {
    fillet::SearchTurns(vehicle, route, speed, options, seed, limits, turns);
  }
  FilletPlan plan = fillet::LayOut(vehicle, route, std::move(turns));
  plan.schedule = plan.turns.empty() ? SteeringSchedule({}, {}, options.neutral_steering)
                                     : fillet::MakeSchedule(vehicle, plan.turns);
  if (options.objective == RadiusObjective::kDriven && !plan.turns.empty()) {
    plan = fillet::SearchDriven(vehicle, route, options, seed, limits, plan);
  }
  for (std::size_t k = 0; k < plan.turns.size(); ++k) {
    plan.turns[k].active = fillet::ActiveAt(limits[k], plan.turns[k].radius);
  }
  return plan;
}

}  // namespace

const char* ToString(ActiveConstraint constraint) {
  switch (constraint) {
    case ActiveConstraint::kGiven:
      return "given";
    case ActiveConstraint::kNone:
      return "none";
    case ActiveConstraint::kMinRadius:
      return "min_radius";
    case ActiveConstraint::kMaxRadius:
      return "max_radius";
    case ActiveConstraint::kHalfLeg:
      return "half_leg";
    case ActiveConstraint::kSteeringRoom:
      return "steering_room";
    case ActiveConstraint::kWaypointMiss:
      return "waypoint_miss";
  }
  throw InternalError("no such constraint");
}

FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options, std::uint64_t seed) {
  TRACKBED_CHECK(speed > 0.0 && vehicle.steering_rate > 0.0, "speed {}, steering rate {}", speed,
                 vehicle.steering_rate);
  TRACKBED_CHECK(options.radius || options.constraint != RadiusConstraint::kNone,
                 "without a radius or a constraint there is no largest radius");
  TRACKBED_CHECK(!options.radius || std::isfinite(*options.radius), "radius {}", *options.radius);
  TRACKBED_CHECK(options.min_speed > 0.0, "min_speed {}", options.min_speed);
  FilletPlan plan;
  try {
    if (std::abs(options.neutral_steering) > vehicle.steering_limit) {
      throw Refusal{
          PlanStatus::kTurnTooTight, -1,
          fmt::format("neutral_steering {:.4g} rad exceeds the steering limit of {:.4g} rad",
                      options.neutral_steering, vehicle.steering_limit)};
    }
    const Route route =
        fillet::WithoutCloseWaypoints(vehicle, fillet::MakeRoute(waypoints), speed, options);
    plan = PlanRoute(vehicle, route, speed, options, seed);
    for (int i = 1; i + 1 < static_cast<int>(waypoints.size()); ++i) {
      if (fillet::IsLeftOut(route, waypoints, i)) {
        plan.left_out.push_back(i);
      }
    }
    plan.verification =
        SimulateOpenLoop(vehicle, plan.path, plan.schedule, plan.stop_distance, options.reference);
  } catch (const Refusal& refusal) {
    plan = {};
    plan.status = refusal.status;
    plan.waypoint = refusal.waypoint;
    plan.reason = refusal.reason;
  }
  return plan;
}

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
              "constraint on the radius: leaves room for the steering ramps, fits half the "
              "shorter leg, or none"},
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
  keys.Field(
      {"without_room", "", "what to do about turns for which steering_room leaves no radius"},
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

}  // namespace trackbed

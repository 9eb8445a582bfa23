#include "src/planning/fillet/fillet_radius.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/fillet/feasible_root.h"
#include "src/planning/fillet/fillet_layout.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/common/waypoint_miss.h"
#include "trackbed/planning/fillet/steering_room.h"

// Computes the limits of a turn's radius (Skackauskas, dissertation, eqs. (C.34) and (C.40)).
// Equation C.34 limits the tangent length of the turn to half of the shorter adjacent leg. Equation
// C.40 also reserves the distance that the car drives while its wheels turn (steering_room.h). If
// no radius is permitted at the mission's speed, the planner's options decide what happens. The
// turn gets a lower speed, is refused, or is limited only by its tangent length.

namespace trackbed::fillet {
namespace {

/// Returns the argument `neutral` of SteeringRoomRadii: the neutral steering angle [rad], positive
/// toward the inside of the turn.
double NeutralTowardTurn(const FilletTurn& turn) {
  return turn.heading_change < 0.0 ? -turn.neutral : turn.neutral;
}

Refusal RefuseTurn(const FilletTurn& turn, PlanStatus status, const std::string& why) {
  return {status, turn.waypoint,
          fmt::format("turn of {:.4g} deg at waypoint {}: {}", turn.heading_change * 180.0 / kPi,
                      turn.waypoint, why)};
}

/// Returns the distance of an arc of radius 1 m from the waypoint between its tangents [m].
double UnitMiss(double interior_angle) {
  return 1.0 / std::sin(0.5 * interior_angle) - 1.0;
}

/// Returns the largest radius of an arc that passes a waypoint at a distance of at most `max_miss`
/// [m].
double LargestRadiusNear(double max_miss, double interior_angle) {
  const double unit = UnitMiss(interior_angle);
  return unit > 0.0 ? max_miss / unit : std::numeric_limits<double>::infinity();
}

std::string DescribeMiss(double max_miss, const FilletTurn& turn, double radius) {
  const double miss = radius * UnitMiss(turn.interior_angle);
  return fmt::format(
      "missed by {:.4g} m, more than {:.4g} m: the turn of {:.4g} deg there has a radius of {:.4g} "
      "m; {}",
      miss, max_miss, turn.heading_change * 180.0 / kPi, radius, RemedyForMiss(miss));
}

/// Describes the remedy for a turn that needs `needed` [m] of half of each leg, rounded so that it
/// is sufficient.
std::string LongerLegs(double needed) {
  return fmt::format("make its legs at least {:.10g} m long, or use plan.method: dubins",
                     0.01 * std::ceil(200.0 * needed));
}

/// Describes a turn whose legs are too short for the radius `radius` [m], with a remedy. The remedy
/// is a smaller radius if the car can turn on it, otherwise a longer leg or another planner.
std::string DescribeShortLeg(const FilletTurn& turn, double radius, double min_turning_radius) {
  const double half_leg = 0.5 * turn.shorter_leg;
  const double per_leg = std::tan(0.5 * turn.interior_angle);
  const double millimeters = 1000.0 * half_leg * per_leg;
  // Round the proposed radius down to millimeters, so that its turn fits on the legs.
  const std::string remedy =
      half_leg * per_leg >= min_turning_radius
          ? fmt::format("set plan.radius to at most {:.10g}", 0.001 * std::floor(millimeters))
          : LongerLegs(radius / per_leg);
  return fmt::format(
      "radius {:.4g} m needs {:.4g} m of each leg; half of the shorter leg is {:.4g} m; {}", radius,
      radius / per_leg, half_leg, remedy);
}

/// Returns the fillet radii at which the steering ramps fit on the legs (equation C.40). If no
/// radius is permitted at the mission's speed, first raises the upper bound to the radius that
/// leaves most room for steering, at most to `largest`. If the steering ramps still fit at no
/// radius, lowers the speed of the turn. Returns nullopt if the options limit the radius only by
/// the length of the legs (equation C.34).
std::optional<RadiusInterval> RadiiWithSteeringRoom(const VehicleParams& vehicle, double speed,
                                                    const FilletOptions& options, double largest,
                                                    RadiusInterval& bounds, FilletTurn& turn) {
  const auto room_at = [&](double v) {
    return SteeringRoomRadii(vehicle, v, turn.interior_angle, turn.shorter_leg, bounds,
                             NeutralTowardTurn(turn));
  };
  if (auto room = room_at(speed)) {
    return room;
  }
  // Raise the upper bound of the radius: on a larger radius, the steering ramp of a gentle turn is
  // shorter and may fit on the leg.
  bounds.high = std::max(
      bounds.high, RoomiestRadius(vehicle, speed, turn.interior_angle, NeutralTowardTurn(turn),
                                  {bounds.low, std::max(bounds.low, largest)}));
  if (auto room = room_at(speed)) {
    return room;
  }
  const std::string why = fmt::format(
      "at {:.4g} m/s no radius from {:.4g} to {:.4g} m leaves room for the steering ramp "
      "within half of the shorter leg, {:.4g} m",
      speed, bounds.low, bounds.high, turn.shorter_leg / 2.0);
  if (options.without_room == InfeasibleTurnPolicy::kRefuse) {
    const double radius =
        RoomiestRadius(vehicle, speed, turn.interior_angle, NeutralTowardTurn(turn), bounds);
    const double needed =
        SteeringRoom(vehicle, speed, turn.interior_angle, 0.0, NeutralTowardTurn(turn), radius);
    throw RefuseTurn(
        turn, PlanStatus::kNoRoomForSteering,
        fmt::format("{}; set plan.without_room: slow_down, {}", why, LongerLegs(needed)));
  }
  if (options.without_room == InfeasibleTurnPolicy::kHalfLeg) {
    turn.note = why + "; under half_leg instead";
    return std::nullopt;
  }
  const auto slower =
      options.min_speed < speed
          ? SteeringRoomSpeed(vehicle, turn.interior_angle, turn.shorter_leg, bounds,
                              {options.min_speed, speed}, NeutralTowardTurn(turn))
          : std::nullopt;
  if (slower) {
    turn.speed = *slower;
    turn.note = fmt::format("{}; speed reduced to {:.4g} m/s", why, *slower);
    return room_at(*slower);
  }
  // The room condition (equation C.40) reserves a whole steering ramp on the leg, although half of
  // the ramp lies on the arc.
  const double v = std::min(options.min_speed, speed);
  const auto room =
      SteeringRoomRadii(vehicle, 0.5 * v, turn.interior_angle, turn.shorter_leg, bounds);
  if (!room) {
    throw RefuseTurn(
        turn, PlanStatus::kNoRoomForSteering,
        fmt::format("{}, and at {:.4g} m/s its ramps would overlap those of its neighbors; {}", why,
                    v,
                    LongerLegs(LeastSteeringRoom(vehicle, 0.5 * v, turn.interior_angle, bounds))));
  }
  turn.speed = v;
  turn.note = fmt::format("{}; speed reduced to {:.4g} m/s, half of the ramp on the leg", why, v);
  return room;
}

/// Returns the amount by which the length S of the steering ramp to a radius exceeds the longest
/// permitted length [m]. A steering ramp centered on the tangent point displaces the car from the
/// arc by S^2/(24 r). A steering ramp may displace the car from the arc by a quarter of the car's
/// width.
double RampExcess(const VehicleParams& vehicle, const FilletTurn& turn, double speed,
                  double radius) {
  const double travel = SteeringForCurvature(vehicle, 1.0 / radius) - NeutralTowardTurn(turn);
  return std::abs(SteeringDistance(vehicle, travel, speed)) -
         std::sqrt(24.0 * radius * kUnnoticedShareOfWidth * vehicle.width);
}

/// Lowers the speed of a turn, at most to `min_speed`, until the steering ramp to the largest
/// radius is short enough. Returns the radii at which the steering ramps fit on the legs at the new
/// speed (equation C.40).
RadiusInterval SlowDownForRamp(const VehicleParams& vehicle, const FilletOptions& options,
                               const RadiusInterval& bounds, const RadiusInterval& room,
                               FilletTurn& turn) {
  const double slowest = std::min(options.min_speed, turn.speed);
  if (options.radius || options.without_room != InfeasibleTurnPolicy::kSlowDown ||
      slowest >= turn.speed || RampExcess(vehicle, turn, turn.speed, room.high) <= 0.0) {
    return room;
  }
  // At a lower speed, the largest permitted radius is larger, and the steering ramp to this radius
  // is shorter.
  const auto room_at = [&](double v) {
    return SteeringRoomRadii(vehicle, v, turn.interior_angle, turn.shorter_leg, bounds,
                             NeutralTowardTurn(turn))
        .value_or(room);
  };
  const auto excess = [&](double v) { return RampExcess(vehicle, turn, v, room_at(v).high); };
  const double slower = excess(slowest) > 0.0 ? slowest : FeasibleRoot(excess, slowest, turn.speed);
  turn.note = fmt::format(
      "{}{}at {:.4g} m/s the wheels turn too slowly for a radius of {:.4g} m; speed reduced to "
      "{:.4g} m/s",
      turn.note, turn.note.empty() ? "" : "; ", turn.speed, room.high, slower);
  turn.speed = slower;
  return room_at(slower);
}

}  // namespace

RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn) {
  const double r_min = vehicle.min_turning_radius();
  // Relative tolerance for the rounding error of the minimum radius, which is computed from the
  // limit of the steering angle.
  const double tolerance = 1e-9 * r_min;
  const auto refuse = [&](PlanStatus status, const std::string& why) {
    return RefuseTurn(turn, status, why);
  };
  if (options.radius && *options.radius < r_min - tolerance) {
    throw refuse(PlanStatus::kTurnTooTight,
                 fmt::format("radius {:.4g} m is below the minimum turning radius of {:.4g} m",
                             *options.radius, r_min));
  }
  if (!options.radius && options.max_radius < r_min - tolerance) {
    throw refuse(
        PlanStatus::kTurnTooTight,
        fmt::format(
            "the largest radius allowed, {:.4g} m, is below the minimum turning radius of {:.4g} m",
            options.max_radius, r_min));
  }
  turn.speed = speed;
  turn.neutral = options.neutral_steering;
  const double near = LargestRadiusNear(options.max_waypoint_miss, turn.interior_angle);
  RadiusInterval bounds =
      options.radius ? RadiusInterval{*options.radius, *options.radius}
                     : RadiusInterval{r_min, std::min(near, std::max(r_min, options.max_radius))};
  if (options.radius && options.constraint == RadiusConstraint::kNone) {
    return {bounds, ActiveConstraint::kGiven, ActiveConstraint::kGiven, options.constraint};
  }
  const auto half_leg = HalfLegRadii(turn.interior_angle, turn.shorter_leg, bounds);
  if (!half_leg) {
    throw refuse(PlanStatus::kTurnTooTight, DescribeShortLeg(turn, bounds.low, r_min));
  }
  RadiusLimits limits{*half_leg, ActiveConstraint::kMinRadius, ActiveConstraint::kHalfLeg,
                      RadiusConstraint::kHalfLeg};
  if (options.constraint == RadiusConstraint::kSteeringRoom) {
    auto room =
        RadiiWithSteeringRoom(vehicle, speed, options, options.radius.value_or(near), bounds, turn);
    if (room) {
      room = SlowDownForRamp(vehicle, options, bounds, *room, turn);
      limits = {
          *room,
          room->low > bounds.low ? ActiveConstraint::kSteeringRoom : ActiveConstraint::kMinRadius,
          ActiveConstraint::kSteeringRoom, RadiusConstraint::kSteeringRoom};
    }
  }
  if (options.radius) {
    limits.radii = bounds;
    limits.at_low = limits.at_high = ActiveConstraint::kGiven;
  } else if (limits.radii.high >= bounds.high) {
    limits.at_high = near <= bounds.high                ? ActiveConstraint::kWaypointMiss
                     : bounds.high > options.max_radius ? ActiveConstraint::kSteeringRoom
                                                        : ActiveConstraint::kMaxRadius;
  }
  return limits;
}

void CheckMisses(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                 const std::vector<FilletTurn>& turns) {
  const double smallest = options.radius.value_or(vehicle.min_turning_radius());
  const auto worst =
      std::max_element(turns.begin(), turns.end(), [](const FilletTurn& a, const FilletTurn& b) {
        return UnitMiss(a.interior_angle) < UnitMiss(b.interior_angle);
      });
  if (worst == turns.end() ||
      smallest <= LargestRadiusNear(options.max_waypoint_miss, worst->interior_angle)) {
    return;
  }
  FilletOptions unbounded = options;
  unbounded.max_waypoint_miss = std::numeric_limits<double>::infinity();
  for (FilletTurn turn : turns) {
    static_cast<void>(LimitRadius(vehicle, speed, unbounded, turn));
  }
  throw Refusal{PlanStatus::kWaypointMissed, worst->waypoint,
                DescribeMiss(options.max_waypoint_miss, *worst, smallest)};
}

ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius) {
  constexpr double kActiveTolerance = 1e-3;
  if (radius >= limits.radii.high * (1.0 - kActiveTolerance)) {
    return limits.at_high;
  }
  return radius <= limits.radii.low * (1.0 + kActiveTolerance) ? limits.at_low
                                                               : ActiveConstraint::kNone;
}

double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius) {
  return constraint == RadiusConstraint::kSteeringRoom
             ? SteeringRoom(vehicle, turn.speed, turn.interior_angle, turn.shorter_leg,
                            NeutralTowardTurn(turn), radius)
             : radius / std::tan(turn.interior_angle / 2.0) - 0.5 * turn.shorter_leg;
}

}  // namespace trackbed::fillet

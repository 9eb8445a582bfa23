#include "trackbed/planning/fillet.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Relative room for rounding, so that a radius that lies exactly on a limit is not refused.
constexpr double kRounding = 1e-12;
constexpr double kNoTurn = 1e-9;  // heading change [rad] below which legs count as collinear

struct Leg {
  double length;
  Vec2 direction;
};

/// Thrown inside this file to leave the planning of a route at its first obstacle.
struct Refusal {
  PlanStatus status;
  int waypoint;
  std::string reason;
};

double Degrees(double radians) {
  return radians * 180.0 / kPi;
}

/// A root of f between a and b, where it changes sign, on the side where f <= 0.
template <typename Function>
double Root(const Function& f, double a, double b) {
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(
      f, a, b, boost::math::tools::eps_tolerance<double>(52), iterations);
  return f(high) <= 0.0 ? high : low;
}

std::vector<Leg> LegsOf(const std::vector<Vec2>& waypoints) {
  if (waypoints.size() < 3) {
    throw Refusal{PlanStatus::kTooFewWaypoints, static_cast<int>(waypoints.size()) - 1,
                  fmt::format("{} waypoints; a route needs at least 3", waypoints.size())};
  }
  std::vector<Leg> legs;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Vec2 leg = waypoints[i + 1] - waypoints[i];
    const double length = leg.norm();
    TRACKBED_CHECK(std::isfinite(length), "waypoint {} or {} is not finite", i, i + 1);
    if (length == 0.0) {
      throw Refusal{PlanStatus::kDuplicateWaypoints, static_cast<int>(i) + 1,
                    fmt::format("waypoint {} is the same point as waypoint {}, ({}, {})", i + 1, i,
                                waypoints[i].x(), waypoints[i].y())};
    }
    legs.push_back({length, leg / length});
  }
  return legs;
}

/// The radius of a turn whose angles are known, or a Refusal.
double ChooseRadius(const VehicleParams& vehicle, const FilletTurn& turn, double shorter_leg,
                    double speed, const FilletOptions& options) {
  const double r_min = vehicle.min_turning_radius();
  // The model's limit is an angle: its radius comes back with rounding, which must not refuse it.
  const double tolerance = 1e-9 * r_min;
  const auto refuse = [&](PlanStatus status, const std::string& why) {
    return Refusal{status, turn.waypoint,
                   fmt::format("turn of {:.4g} deg at waypoint {}: {}",
                               Degrees(turn.heading_change), turn.waypoint, why)};
  };
  if (options.radius && *options.radius < r_min - tolerance) {
    throw refuse(PlanStatus::kTurnTooTight,
                 fmt::format("the given radius of {:.4g} m is below the car's smallest, {:.4g} m",
                             *options.radius, r_min));
  }
  if (!options.radius && options.max_radius < r_min - tolerance) {
    throw refuse(PlanStatus::kTurnTooTight,
                 fmt::format("the largest radius allowed, {:.4g} m, is below the car's smallest, "
                             "{:.4g} m",
                             options.max_radius, r_min));
  }
  if (options.radius && options.constraint == RadiusConstraint::kNone) {
    return *options.radius;
  }
  const RadiusInterval bounds = options.radius ? RadiusInterval{*options.radius, *options.radius}
                                               : RadiusInterval{r_min, options.max_radius};
  const auto half_leg = HalfLegRadii(turn.interior_angle, shorter_leg, bounds);
  if (!half_leg) {
    throw refuse(PlanStatus::kTurnTooTight,
                 fmt::format("a radius of {:.4g} m needs {:.4g} m of each leg, and half of the "
                             "shorter one is {:.4g} m",
                             bounds.low, bounds.low / std::tan(turn.interior_angle / 2.0),
                             shorter_leg / 2.0));
  }
  if (options.constraint != RadiusConstraint::kSteeringRoom) {
    return half_leg->high;
  }
  const auto room = SteeringRoomRadii(vehicle, speed, turn.interior_angle, shorter_leg, bounds);
  if (!room) {
    throw refuse(PlanStatus::kNoRoomForSteering,
                 fmt::format("at {:.4g} m/s no radius from {:.4g} to {:.4g} m leaves the distance "
                             "to turn the wheels within half of the shorter leg, {:.4g} m (C.40)",
                             speed, bounds.low, bounds.high, shorter_leg / 2.0));
  }
  return room->high;
}

std::vector<FilletTurn> TurnsOf(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                                const std::vector<Leg>& legs, double speed,
                                const FilletOptions& options) {
  std::vector<FilletTurn> turns;
  for (std::size_t i = 0; i + 1 < legs.size(); ++i) {
    const Leg& in = legs[i];
    const Leg& out = legs[i + 1];
    FilletTurn turn;
    turn.waypoint = static_cast<int>(i) + 1;
    // atan2 instead of C.9's arc cosine: signed, and without its rounding trouble near 0 and pi.
    turn.heading_change =
        std::atan2(Cross(in.direction, out.direction), in.direction.dot(out.direction));
    turn.interior_angle = kPi - std::abs(turn.heading_change);
    if (std::abs(turn.heading_change) < kNoTurn) {
      continue;
    }
    if (turn.interior_angle < kNoTurn) {
      throw Refusal{PlanStatus::kUTurn, turn.waypoint,
                    fmt::format("the route turns back on itself at waypoint {}", turn.waypoint)};
    }
    turn.radius = ChooseRadius(vehicle, turn, std::min(in.length, out.length), speed, options);
    turn.tangent_length = turn.radius / std::tan(turn.interior_angle / 2.0);
    const Vec2& w = waypoints[i + 1];
    const double to_centre = turn.radius / std::sin(turn.interior_angle / 2.0);
    turn.centre = w - to_centre * (in.direction - out.direction).normalized();
    turn.arc_start = w - turn.tangent_length * in.direction;
    turn.arc_end = w + turn.tangent_length * out.direction;
    turn.arc_length = turn.radius * std::abs(turn.heading_change);
    turns.push_back(turn);
  }
  return turns;
}

/// Straight from corner to corner, round each, straight to the end; fills in the stations.
Path PathThrough(const std::vector<Vec2>& waypoints, const std::vector<Leg>& legs,
                 std::vector<FilletTurn>& turns) {
  std::vector<Segment> segments;
  double s = 0.0;
  const auto straight = [&](double length, int waypoint) {
    // Turns whose tangent points coincide leave no straight; rounding may even leave a little less.
    constexpr double negligible = 1e-10;  // [m]
    if (length < -negligible) {
      throw Refusal{PlanStatus::kTurnsOverlap, waypoint,
                    fmt::format("the arcs before waypoint {} need {:.4g} m more than their leg has",
                                waypoint, -length)};
    }
    if (length > negligible) {
      segments.push_back({length, 0.0, 1});
      s += length;
    }
  };
  // Straight distance since the last arc; collinear legs add up.
  double pending = 0.0;
  auto turn = turns.begin();
  for (std::size_t i = 0; i < legs.size(); ++i) {
    pending += legs[i].length;
    const int waypoint = static_cast<int>(i) + 1;
    if (turn == turns.end() || turn->waypoint != waypoint) {
      continue;
    }
    straight(pending - turn->tangent_length, waypoint);
    turn->arc_start_s = s;
    segments.push_back(
        {turn->arc_length, std::copysign(1.0 / turn->radius, turn->heading_change), 1});
    s += turn->arc_length;
    pending = -turn->tangent_length;
    ++turn;
  }
  straight(pending, static_cast<int>(legs.size()));
  const Vec2& d = legs.front().direction;
  return Path({waypoints[0].x(), waypoints[0].y(), std::atan2(d.y(), d.x())}, std::move(segments));
}

SteeringSchedule ScheduleFor(const VehicleParams& vehicle, double speed,
                             std::vector<FilletTurn>& turns) {
  std::vector<TurnSteering> steering;
  for (FilletTurn& turn : turns) {
    const double delta = SteeringForCurvature(vehicle, 1.0 / turn.radius);
    turn.steering = std::copysign(delta, turn.heading_change);
    turn.ramp_time = delta / vehicle.steering_rate;
    turn.ramp_distance = SteeringDistance(vehicle, delta, speed);
    turn.ramp_truncated = turn.arc_length < turn.ramp_distance;
    turn.steer_start = turn.arc_start_s - turn.ramp_distance / 2.0;
    turn.steer_return = turn.steer_start + turn.arc_length;
    if (turn.steer_start < 0.0) {
      throw Refusal{
          PlanStatus::kSteersBeforeStart, turn.waypoint,
          fmt::format("for the turn at waypoint {} the wheels would have to start turning {:.4g} m "
                      "before the route begins",
                      turn.waypoint, -turn.steer_start)};
    }
    if (!steering.empty() && turn.steer_start < steering.back().start) {
      throw Refusal{
          PlanStatus::kTurnsOverlap, turn.waypoint,
          fmt::format("for the turn at waypoint {} the wheels would have to start turning "
                      "before those of the turn before it",
                      turn.waypoint)};
    }
    steering.push_back({turn.steer_start, turn.steer_return, turn.steering});
  }
  return {steering, vehicle.steering_rate / speed};
}

}  // namespace

std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds) {
  const double largest = 0.5 * shorter_leg * std::tan(interior_angle / 2.0);
  if (largest < bounds.low * (1.0 - kRounding)) {
    return std::nullopt;
  }
  return RadiusInterval{bounds.low, std::clamp(largest, bounds.low, bounds.high)};
}

std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds) {
  const double tangent = std::tan(interior_angle / 2.0);
  const double per_radian = speed / vehicle.steering_rate;  // K0
  const double L = vehicle.wheelbase;
  const auto g = [&](double r) {
    return r / tangent + per_radian * std::atan(L / r) - 0.5 * shorter_leg;
  };
  const double lowest_squared = per_radian * L * tangent - L * L;
  const double lowest =
      std::clamp(std::sqrt(std::max(0.0, lowest_squared)), bounds.low, bounds.high);
  if (g(lowest) > kRounding * shorter_leg) {
    return std::nullopt;
  }
  if (g(lowest) > 0.0) {
    return RadiusInterval{lowest, lowest};
  }
  return RadiusInterval{g(bounds.low) <= 0.0 ? bounds.low : Root(g, bounds.low, lowest),
                        g(bounds.high) <= 0.0 ? bounds.high : Root(g, lowest, bounds.high)};
}

FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options) {
  TRACKBED_CHECK(speed > 0.0 && vehicle.steering_rate > 0.0, "speed {}, steering rate {}", speed,
                 vehicle.steering_rate);
  TRACKBED_CHECK(options.radius || options.constraint != RadiusConstraint::kNone,
                 "without a radius or a constraint there is no largest radius");
  TRACKBED_CHECK(!options.radius || std::isfinite(*options.radius), "radius {}", *options.radius);
  FilletPlan plan;
  try {
    const std::vector<Leg> legs = LegsOf(waypoints);
    plan.turns = TurnsOf(vehicle, waypoints, legs, speed, options);
    plan.path = PathThrough(waypoints, legs, plan.turns);
    plan.schedule = ScheduleFor(vehicle, speed, plan.turns);
  } catch (const Refusal& refusal) {
    plan = {};
    plan.status = refusal.status;
    plan.waypoint = refusal.waypoint;
    plan.reason = refusal.reason;
  }
  return plan;
}

}  // namespace trackbed

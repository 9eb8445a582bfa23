#include "src/planning/fillet/fillet_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/route_start.h"

namespace trackbed::fillet {
namespace {

// Heading change between two legs below which the legs count as collinear [rad].
constexpr double kNoTurn = 1e-9;

void PlaceArc(const Route& route, FilletTurn& turn) {
  const auto corner = static_cast<std::size_t>(
      std::find(route.numbers.begin() + 1, route.numbers.end(), turn.waypoint) -
      route.numbers.begin());
  const Leg& in = route.legs[corner - 1];
  const Leg& out = route.legs[corner];
  const Vec2& w = route.waypoints[corner];
  turn.tangent_length = turn.radius / std::tan(turn.interior_angle / 2.0);
  const double to_center = turn.radius / std::sin(turn.interior_angle / 2.0);
  turn.center = w - to_center * (in.direction - out.direction).normalized();
  turn.arc_start = w - turn.tangent_length * in.direction;
  turn.arc_end = w + turn.tangent_length * out.direction;
  turn.arc_length = turn.radius * std::abs(turn.heading_change);
}

/// Makes the path of straights and arcs along the route and stores the stations of the turns.
Path PathThrough(const Route& route, std::vector<FilletTurn>& turns) {
  std::vector<Segment> segments;
  double s = 0.0;
  const auto straight = [&](double length, int waypoint) {
    // The straight between two turns has length zero, up to rounding, if the end of the first arc
    // is the start of the second.
    constexpr double negligible = 1e-10;  // [m]
    if (length < -negligible) {
      throw Refusal{PlanStatus::kTurnsOverlap, waypoint,
                    fmt::format("the arcs before waypoint {} exceed their leg by {:.4g} m",
                                waypoint, -length)};
    }
    if (length > negligible) {
      segments.push_back({length, 0.0, 1});
      s += length;
    }
  };
  // Length of the straight since the end of the last arc [m]; a straight may extend over several
  // collinear legs.
  double pending = 0.0;
  auto turn = turns.begin();
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    pending += route.legs[i].length;
    const int waypoint = route.numbers[i + 1];
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
  straight(pending, route.numbers.back());
  return {StartOfRoute(route.waypoints), std::move(segments)};
}

void CenterRamps(const VehicleParams& vehicle, FilletTurn& turn) {
  const double delta = SteeringForCurvature(vehicle, 1.0 / turn.radius);
  turn.steering = std::copysign(delta, turn.heading_change);
  const double travel = turn.steering - turn.neutral;
  turn.ramp_time = std::abs(travel) / vehicle.steering_rate;
  turn.ramp_distance = SteeringDistance(vehicle, travel, turn.speed);
  turn.ramp_truncated = turn.arc_length < turn.ramp_distance;
  turn.steer_start = turn.arc_start_s - turn.ramp_distance / 2.0;
  turn.steer_return = turn.steer_start + turn.arc_length;
}

}  // namespace

Route MakeRoute(const std::vector<Vec2>& waypoints) {
  if (waypoints.size() < kMinFilletWaypoints) {
    throw Refusal{
        PlanStatus::kTooFewWaypoints, static_cast<int>(waypoints.size()) - 1,
        fmt::format("{} waypoints; must be at least {}", waypoints.size(), kMinFilletWaypoints)};
  }
  Route route{waypoints, {}, std::vector<int>(waypoints.size())};
  std::iota(route.numbers.begin(), route.numbers.end(), 0);
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Vec2 leg = waypoints[i + 1] - waypoints[i];
    const double length = leg.norm();
    TRACKBED_CHECK(std::isfinite(length), "waypoint {} or {} is not finite", i, i + 1);
    if (length == 0.0) {
      throw Refusal{PlanStatus::kDuplicateWaypoints, static_cast<int>(i) + 1,
                    fmt::format("waypoint {} is the same point as waypoint {}, ({}, {})", i + 1, i,
                                waypoints[i].x(), waypoints[i].y())};
    }
    route.legs.push_back({length, leg / length});
  }
  return route;
}

std::vector<FilletTurn> FindTurns(const Route& route) {
  std::vector<FilletTurn> turns;
  for (std::size_t i = 0; i + 1 < route.legs.size(); ++i) {
    const Leg& in = route.legs[i];
    const Leg& out = route.legs[i + 1];
    FilletTurn turn;
    turn.waypoint = route.numbers[i + 1];
    // Use atan2 instead of the arc cosine in equation C.9, because atan2 yields the sign and is
    // accurate near 0 and pi.
    turn.heading_change =
        std::atan2(Cross(in.direction, out.direction), in.direction.dot(out.direction));
    turn.interior_angle = kPi - std::abs(turn.heading_change);
    turn.shorter_leg = std::min(in.length, out.length);
    if (std::abs(turn.heading_change) < kNoTurn) {
      continue;
    }
    if (turn.interior_angle < kNoTurn) {
      throw Refusal{PlanStatus::kUTurn, turn.waypoint,
                    fmt::format("the route turns back on itself at waypoint {}", turn.waypoint)};
    }
    turns.push_back(turn);
  }
  return turns;
}

FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns) {
  FilletPlan plan;
  plan.turns = std::move(turns);
  for (FilletTurn& turn : plan.turns) {
    PlaceArc(route, turn);
  }
  plan.path = PathThrough(route, plan.turns);
  for (FilletTurn& turn : plan.turns) {
    CenterRamps(vehicle, turn);
  }
  plan.stop_distance = plan.path.length();
  return plan;
}

SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns) {
  std::vector<TurnSteering> steering;
  std::vector<double> slopes;
  for (const FilletTurn& turn : turns) {
    if (turn.steer_start < 0.0) {
      throw Refusal{PlanStatus::kSteersBeforeStart, turn.waypoint,
                    fmt::format("the steering for the turn at waypoint {} would have to start "
                                "{:.4g} m before the route",
                                turn.waypoint, -turn.steer_start)};
    }
    if (!steering.empty() && turn.steer_start < steering.back().start) {
      throw Refusal{PlanStatus::kTurnsOverlap, turn.waypoint,
                    fmt::format("the steering for the turn at waypoint {} would have to start "
                                "before that of the previous turn",
                                turn.waypoint)};
    }
    steering.push_back({turn.steer_start, turn.steer_return, turn.steering});
    slopes.push_back(vehicle.steering_rate / turn.speed);
  }
  return {steering, slopes, turns.empty() ? 0.0 : turns.front().neutral};
}

}  // namespace trackbed::fillet

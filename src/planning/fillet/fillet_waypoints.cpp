#include "src/planning/fillet/fillet_waypoints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/fillet/steering_room.h"

// Leaves out waypoints between which no turn fits, such as points on a line that were rounded to
// millimeters. LeaveOutCloseWaypoints chooses the points to leave out. If the car slows down where
// turns lack room, a first pass leaves out waypoints that lie off a straight line only because of
// rounded coordinates. Without the first pass, the car would slow down at each waypoint that
// rounding moved off a straight line. A second pass leaves out waypoints at which no turn fits at
// all. The car begins in the direction of the first leg. If the first waypoint is too close to the
// start for a turn, the path continues straight through this waypoint, and turns beyond it. If the
// path leaves out the first waypoint, it may turn on the first leg.

namespace trackbed::fillet {
namespace {

/// Returns the part of each leg that a turn needs at `speed`, for the best radius that LimitRadius
/// permits [m].
double LeastLeg(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                double heading_change) {
  const double smallest = options.radius.value_or(vehicle.min_turning_radius());
  const double tangent = smallest * std::tan(0.5 * heading_change);
  if (options.constraint != RadiusConstraint::kSteeringRoom ||
      options.without_room == InfeasibleTurnPolicy::kHalfLeg) {
    return tangent;
  }
  const double largest = options.radius ? smallest : std::numeric_limits<double>::infinity();
  return LeastSteeringRoom(vehicle, speed, kPi - heading_change, {smallest, largest});
}

/// Returns the number of corners of a polyline that lack the room that they need.
int TightCorners(const std::vector<Vec2>& points, const WaypointChoice& choice) {
  int tight = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 in = points[i] - points[i - 1];
    const Vec2 out = points[i + 1] - points[i];
    const CornerRoom corner = choice.room(std::abs(std::atan2(Cross(in, out), in.dot(out))));
    const bool fits =
        corner.tangent <= 0.5 * std::min(in.norm(), out.norm()) && corner.gap <= choice.max_gap;
    tight += fits ? 0 : 1;
  }
  return tight;
}

/// Whether a polyline passes all waypoints within `distance` [m].
bool PassesNear(const std::vector<Vec2>& points, const std::vector<Vec2>& waypoints,
                double distance) {
  constexpr double kRounding = 1e-9;  // [m]
  return std::all_of(waypoints.begin(), waypoints.end(), [&](const Vec2& at) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vec2 along = points[i] - points[i - 1];
      const double share =
          std::clamp((at - points[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      if ((at - points[i - 1] - share * along).norm() <= distance + kRounding) {
        return true;
      }
    }
    return false;
  });
}

/// Returns the numbers of the waypoints that are points of the route. A point that was added before
/// the first waypoint has the number of the first waypoint.
std::vector<int> NumbersOf(const std::vector<Vec2>& points, const std::vector<Vec2>& waypoints) {
  std::vector<int> numbers;
  std::size_t next = 0;
  for (const Vec2& point : points) {
    const auto at =
        std::find(waypoints.begin() + static_cast<std::ptrdiff_t>(next), waypoints.end(), point);
    if (at == waypoints.end()) {
      numbers.push_back(1);
      next = 2;
      continue;
    }
    numbers.push_back(static_cast<int>(at - waypoints.begin()));
    next = static_cast<std::size_t>(numbers.back()) + 1;
  }
  return numbers;
}

/// Leaves out waypoints of a route. Of the polylines that pass the waypoints left out within
/// `choice.max_gap`, returns the one with the fewest tight corners. Returns all waypoints if no
/// polyline has fewer tight corners.
std::vector<Vec2> WithFewestTightCorners(const VehicleParams& vehicle, const Route& route,
                                         const std::vector<Vec2>& given,
                                         const WaypointChoice& choice) {
  std::vector<Vec2> best = given;
  int fewest = TightCorners(given, choice);
  std::vector<Vec2> points = given;
  const Leg& first = route.legs.front();
  const double longest = std::max(first.length, 2.0 * vehicle.min_turning_radius());
  // The factor kLonger is not two, so that added points do not coincide with evenly spaced
  // waypoints.
  constexpr double kLonger = 1.9;
  // Trial distances of an added point from the start [m]. The first trial, at the distance 0, adds
  // no point.
  std::vector<double> distances{0.0, first.length / kLonger};
  for (double length = kLonger * first.length; length <= longest; length *= kLonger) {
    distances.push_back(length);
  }
  for (const double distance : distances) {
    if (fewest == 0) {
      break;
    }
    points = given;
    if (distance > 0.0) {
      points.insert(points.begin() + 1, points[0] + distance * first.direction);
    }
    std::vector<Vec2> fewer = LeaveOutCloseWaypoints(points, choice);
    const int tight = TightCorners(fewer, choice);
    // If the path with an added point has a corner that does not fit, the path may double back.
    const bool may_help = tight == 0 || distance == 0.0;
    if (tight < fewest && may_help && PassesNear(fewer, route.waypoints, choice.max_gap)) {
      best = std::move(fewer);
      fewest = tight;
    }
  }
  return best;
}

}  // namespace

Route WithoutCloseWaypoints(const VehicleParams& vehicle, const Route& route, double speed,
                            const FilletOptions& options) {
  if (options.constraint == RadiusConstraint::kNone) {
    return route;
  }
  const double smallest = options.radius.value_or(vehicle.min_turning_radius());
  // An arc that passes its waypoint too far away does not fit.
  const auto choice_at = [&](double turn_speed, double share_of_width) {
    return WaypointChoice{
        .waypoints = route.waypoints,
        .max_gap = std::min(options.max_waypoint_miss, share_of_width * vehicle.width),
        .room = [&, turn_speed](double turn) -> CornerRoom {
          const double miss = smallest * (1.0 / std::cos(0.5 * turn) - 1.0);
          return {
              LeastLeg(vehicle, turn_speed, options, turn),
              miss <= options.max_waypoint_miss ? 0.0 : std::numeric_limits<double>::infinity()};
        },
        .end_share = 0.5};
  };
  std::vector<Vec2> points = route.waypoints;
  double lowest = speed;
  if (options.without_room == InfeasibleTurnPolicy::kSlowDown) {
    // Largest distance from the path to a waypoint that the first pass leaves out: about the
    // rounding error of coordinates in decimeters.
    constexpr double kRounding = 0.25 * kUnnoticedShareOfWidth;
    points = WithFewestTightCorners(vehicle, route, points, choice_at(speed, kRounding));
    lowest = 0.5 * std::min(options.min_speed, speed);
  }
  const WaypointChoice choice = choice_at(lowest, kUnnoticedShareOfWidth);
  // Without the waypoints that the first pass leaves out, a turn beside them may be too sharp for
  // its legs. The second pass then begins with all waypoints.
  for (const std::vector<Vec2>& given : {points, route.waypoints}) {
    points = WithFewestTightCorners(vehicle, route, given, choice);
    if (TightCorners(points, choice) == 0) {
      break;
    }
    points = route.waypoints;  // a refusal names a turn of the given route
  }
  if (points == route.waypoints) {
    return route;
  }
  Route shorter = MakeRoute(points);
  shorter.numbers = NumbersOf(points, route.waypoints);
  return shorter;
}

bool IsLeftOut(const Route& route, const std::vector<Vec2>& waypoints, int i) {
  const auto number = std::find(route.numbers.begin(), route.numbers.end(), i);
  if (number == route.numbers.end()) {
    return true;
  }
  // The path passes the first waypoint if the added point lies behind the waypoint, but not if the
  // added point lies before the waypoint.
  const Vec2& point = route.waypoints[static_cast<std::size_t>(number - route.numbers.begin())];
  const Vec2& given = waypoints[static_cast<std::size_t>(i)];
  return (point - waypoints[0]).norm() < (given - waypoints[0]).norm();
}

}  // namespace trackbed::fillet

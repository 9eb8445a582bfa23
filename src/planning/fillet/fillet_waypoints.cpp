#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/fillet/fillet_layout.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/fewer_corners.h"

// Leaves out waypoints between which no turn fits, such as points on a line that were rounded to
// millimeters. The search of LeaveOutCloseWaypoints chooses the points. If the first waypoint is
// too close to the start for a turn, the path continues straight beyond the waypoint, because the
// car begins in the direction of the first leg; the turn follows there.

namespace trackbed::fillet {
namespace {

/// Returns the part of each leg that a turn needs, for the best radius and the lowest speed that
/// LimitRadius permits [m].
double LeastLeg(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                double heading_change) {
  const double smallest = options.radius.value_or(vehicle.min_turning_radius());
  const double tangent = smallest * std::tan(0.5 * heading_change);
  if (options.constraint != RadiusConstraint::kSteeringRoom ||
      options.without_room == InfeasibleTurnPolicy::kHalfLeg) {
    return tangent;
  }
  const bool slows_down = options.without_room == InfeasibleTurnPolicy::kSlowDown;
  const double largest = options.radius ? smallest : std::numeric_limits<double>::infinity();
  return LeastSteeringRoom(vehicle, slows_down ? 0.5 * std::min(options.min_speed, speed) : speed,
                           kPi - heading_change, {smallest, largest});
}

/// Whether every corner of a polyline has the room that it needs.
bool HasRoom(const std::vector<Vec2>& points, const WaypointChoice& choice) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 in = points[i] - points[i - 1];
    const Vec2 out = points[i + 1] - points[i];
    const CornerRoom corner = choice.room(std::abs(std::atan2(Cross(in, out), in.dot(out))));
    if (corner.tangent > 0.5 * std::min(in.norm(), out.norm()) || corner.gap > choice.max_gap) {
      return false;
    }
  }
  return true;
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

/// Returns the numbers of the waypoints that are points of the route. An added point behind the
/// first waypoint has the number of this waypoint.
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

}  // namespace

Route WithoutCloseWaypoints(const VehicleParams& vehicle, const Route& route, double speed,
                            const FilletOptions& options) {
  const double smallest = options.radius.value_or(vehicle.min_turning_radius());
  // An arc that passes its waypoint too far away does not fit.
  const auto room = [&](double turn) -> CornerRoom {
    const double miss = smallest * (1.0 / std::cos(0.5 * turn) - 1.0);
    return {LeastLeg(vehicle, speed, options, turn),
            miss <= options.max_waypoint_miss ? 0.0 : std::numeric_limits<double>::infinity()};
  };
  const WaypointChoice choice{
      .waypoints = route.waypoints,
      .max_gap = std::min(options.max_waypoint_miss, kShareOfWidth * vehicle.width),
      .room = room,
      .end_share = 0.5};
  if (options.constraint == RadiusConstraint::kNone || HasRoom(route.waypoints, choice)) {
    return route;
  }
  std::vector<Vec2> points = route.waypoints;
  const Leg& first = route.legs.front();
  const double longest = std::max(first.length, 2.0 * vehicle.min_turning_radius());
  // Not a factor of two, so that added points do not coincide with evenly spaced waypoints.
  constexpr double kLonger = 1.9;
  for (double length = first.length; length <= longest; length *= kLonger) {
    std::vector<Vec2> fewer = LeaveOutCloseWaypoints(points, choice);
    if (HasRoom(fewer, choice) && PassesNear(fewer, route.waypoints, choice.max_gap)) {
      Route shorter = MakeRoute(fewer);
      shorter.numbers = NumbersOf(fewer, route.waypoints);
      return shorter;
    }
    points = route.waypoints;
    points.insert(points.begin() + 1, points[0] + kLonger * length * first.direction);
  }
  return route;
}

}  // namespace trackbed::fillet

#include "trackbed/planning/common/turn_behind.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/common/waypoint_miss.h"

// Rounds polylines that turn too sharply at a waypoint. Where waypoints are close to each other,
// the path leaves out each waypoint that it passes within the permitted distance anyway. A curve on
// the inner side of a sharp turn passes far from the waypoint, and no curve joins legs that point
// in opposite directions. At a sharp turn, the path leads straight through the waypoint, and makes
// one or two quarter turns beyond it. After the quarter turns, the path returns to the next point
// of the polyline. The added legs have just the length that the curves of the added corners need.
// The corners of an added turn are driven at the highest speed at which a quarter turn still
// reaches the largest curvature. If an added turn at this speed is too wide, its corners are driven
// at the lowest speed.

namespace trackbed {
namespace {

constexpr double kQuarter = 0.5 * kPi;

/// Returns the highest speed at which the curve of a quarter turn reaches the largest curvature
/// [m/s]. At the highest speed v, the largest curvature kappa satisfies kappa^2 = h sigma. Here h =
/// pi/2 is the heading change, and sigma = omega_delta/(L v) the sharpness.
double CompactSpeed(const VehicleParams& vehicle, const CornerLimits& limits) {
  const double speed = kQuarter * vehicle.steering_rate /
                       (vehicle.wheelbase * limits.max_curvature * limits.max_curvature);
  return std::clamp(speed, limits.min_speed, limits.speed);
}

/// A turn beyond a waypoint: straight on, one or two quarter turns to one side (1: left, -1:
/// right), and a corner toward the next point of the polyline.
struct TurnShape {
  double speed = 0.0;  ///< Speed for which the legs are long enough [m/s].
  int quarters = 1;
  double side = 1.0;
};

/// Returns the corners of a turn beyond the point `at`, which the car passes in the direction
/// `ahead`. Returns nullopt if the last corner turns back on itself, or needs ever longer legs.
std::optional<std::vector<Vec2>> CornersBehind(const VehicleParams& vehicle, double max_curvature,
                                               const TurnShape& shape, const Vec2& at,
                                               const Vec2& ahead, const Vec2& next) {
  // Each curve may use half of each of its legs. The margin kMargin covers the rounding errors of
  // halving the legs.
  constexpr double kMargin = 1.0 + 1e-6;
  const auto leg = [&](double heading_change) {
    return 2.0 * kMargin *
           CornerAt(vehicle, heading_change, shape.speed, max_curvature).tangent_length;
  };
  std::vector<Vec2> corners;
  Vec2 from = at;
  Vec2 direction = ahead;
  for (int i = 0; i < shape.quarters; ++i) {
    from += leg(kQuarter) * direction;
    corners.push_back(from);
    direction = shape.side * LeftNormal(direction);
  }
  // A longer last leg makes the last corner sharper, and a sharper corner may need a longer leg.
  constexpr double kGrowth = 1.1;
  constexpr int kMaxRounds = 20;
  double length = leg(kQuarter);
  for (int i = 0; i < kMaxRounds; ++i) {
    const Vec2 last = from + length * direction;
    const Vec2 out = next - last;
    const double turn = std::abs(std::atan2(Cross(direction, out), direction.dot(out)));
    constexpr double kOpposite = 1e-6;  // [rad]
    if (turn > kPi - kOpposite) {
      return std::nullopt;
    }
    const double needed = turn > 0.0 ? leg(turn) : 0.0;
    if (needed <= length) {
      corners.push_back(last);
      return corners;
    }
    length = kGrowth * needed;
  }
  return std::nullopt;
}

/// Returns the turns beyond a waypoint in the order in which to try them. The argument `side` says
/// on which side of the car the next point lies.
std::vector<TurnShape> TurnShapes(const VehicleParams& vehicle, const CornerLimits& limits,
                                  double side) {
  std::vector<TurnShape> shapes;
  for (const double speed : {CompactSpeed(vehicle, limits), limits.min_speed}) {
    for (const int quarters : {1, 2}) {
      shapes.push_back({speed, quarters, side});
      shapes.push_back({speed, quarters, -side});
    }
  }
  return shapes;
}

/// Returns the polyline with an added turn beyond the point `corner`; nullopt if no such turn is
/// drivable and clear of obstacles.
std::optional<std::vector<Vec2>> TurnBehind(const VehicleParams& vehicle,
                                            const std::vector<Vec2>& polyline, std::size_t corner,
                                            const CornerLimits& limits,
                                            const CollisionChecker& clear) {
  const Vec2& at = polyline[corner];
  const Vec2 ahead = (at - polyline[corner - 1]).normalized();
  const Vec2& next = polyline[corner + 1];
  const double own_side = std::copysign(1.0, Cross(ahead, next - at));
  CornerLimits alone = limits;
  alone.waypoints.clear();
  alone.start_speed = 0.0;
  for (const TurnShape& shape : TurnShapes(vehicle, limits, own_side)) {
    const auto behind = CornersBehind(vehicle, limits.max_curvature, shape, at, ahead, next);
    if (!behind) {
      continue;
    }
    // The turn may use only half of its last leg: the curve at the leg's end needs the other half.
    const bool is_last = corner + 2 == polyline.size();
    std::vector<Vec2> turn{polyline[corner - 1], at};
    turn.insert(turn.end(), behind->begin(), behind->end());
    turn.push_back(is_last ? next : Vec2(0.5 * (behind->back() + next)));
    if (RoundCorners(vehicle, turn, alone, clear).status == PlanStatus::kOk) {
      std::vector<Vec2> points = polyline;
      points.insert(points.begin() + static_cast<std::ptrdiff_t>(corner) + 1, behind->begin(),
                    behind->end());
      return points;
    }
  }
  return std::nullopt;
}

/// Adds turns beyond waypoints to a polyline until no corner at a waypoint is too sharp. `rounded`
/// are the corners of the polyline itself.
RoundedCorners TurnBehindSharpCorners(const VehicleParams& vehicle, std::vector<Vec2> points,
                                      RoundedCorners rounded, const CornerLimits& limits,
                                      const CollisionChecker& clear) {
  for (std::size_t i = 0; rounded.sharp_corner && i < limits.waypoints.size(); ++i) {
    const auto turned = TurnBehind(vehicle, points, *rounded.sharp_corner, limits, clear);
    if (!turned) {
      rounded.reason += "; there is no room for a turn behind the waypoint";
      break;
    }
    points = *turned;
    rounded = RoundCorners(vehicle, points, limits, clear);
  }
  return rounded;
}

/// Returns the polyline, followed by polylines with an added corner on the first leg or on its
/// extension, each time farther from the start. Up to the added corner, a rolling car can slow down
/// to the lowest speed.
std::vector<std::vector<Vec2>> WithCornersAhead(const std::vector<Vec2>& polyline,
                                                const CornerLimits& limits) {
  std::vector<std::vector<Vec2>> starts{polyline};
  const Vec2 leg = polyline[1] - polyline[0];
  const double squares =
      limits.start_speed * limits.start_speed - limits.min_speed * limits.min_speed;
  const double braking = std::max(0.0, squares) / (2.0 * limits.deceleration);
  for (const double radii : {0.1, 0.2, 0.4, 0.8, 1.6}) {
    const double length = braking + radii / limits.max_curvature;
    starts.push_back(polyline);
    starts.back().insert(starts.back().begin() + 1, polyline[0] + length * leg.normalized());
  }
  return starts;
}

bool PassesWaypoints(const Path& path, const CornerLimits& limits) {
  const auto miss = LargestWaypointMiss(path, limits.waypoints);
  return !miss || miss->distance <= limits.max_gap + kSameMiss;
}

}  // namespace

RoundedCorners RoundCornersOrTurnBehind(const VehicleParams& vehicle,
                                        const std::vector<Vec2>& polyline,
                                        const CornerLimits& limits, const CollisionChecker& clear) {
  const RoundedCorners as_given = RoundCorners(vehicle, polyline, limits, clear);
  const bool is_bounded = limits.waypoints.size() > 1;
  if (as_given.status == PlanStatus::kOk || as_given.status == PlanStatus::kCollides ||
      !is_bounded) {
    return as_given;
  }
  std::vector<std::vector<Vec2>> candidates;
  for (const std::vector<Vec2>& points : WithCornersAhead(polyline, limits)) {
    std::vector<Vec2> fewer = LeaveOutCloseWaypoints(vehicle, points, limits);
    if (fewer != polyline) {
      candidates.push_back(std::move(fewer));
    }
  }
  // Try turns beyond the waypoints last, because such turns make the longest paths.
  for (const bool turns_behind : {false, true}) {
    for (const std::vector<Vec2>& points : candidates) {
      RoundedCorners rounded = RoundCorners(vehicle, points, limits, clear);
      if (turns_behind) {
        rounded = TurnBehindSharpCorners(vehicle, points, std::move(rounded), limits, clear);
      }
      if (rounded.status == PlanStatus::kOk && PassesWaypoints(rounded.path, limits)) {
        return rounded;
      }
    }
  }
  return TurnBehindSharpCorners(vehicle, polyline, as_given, limits, clear);
}

}  // namespace trackbed

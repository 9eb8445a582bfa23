#include "trackbed/planning/common/corners.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <optional>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/common/waypoint_miss.h"

// Rounds each corner of a polyline by a clothoid, an arc and a second clothoid. The maximum
// steering rate and the speed in the corner determine the sharpness of the clothoids, so the curve
// gets shorter at a lower speed. The curve at a corner may use half of each of the two adjacent
// legs. For each corner, bisection finds the highest speed at which the curve fits on half of each
// leg, and passes close enough to a waypoint at the corner. While the resulting path is too close
// to an obstacle, the algorithm slows the corner nearest to the collision by a fifth.

namespace trackbed {
namespace {

/// Largest heading change of a corner that counts as straight [rad].
constexpr double kStraight = 1e-9;

/// Returns the path segments of a rounded corner; their curvature is positive in a left turn.
std::vector<Segment> ToSegments(const RoundCorner& corner) {
  const double side = std::copysign(1.0, corner.heading_change);
  const double ramp = corner.curvature / corner.sharpness;
  const double arc = std::abs(corner.heading_change) / corner.curvature - ramp;
  std::vector<Segment> segments{
      {.length = ramp, .curvature = 0.0, .direction = 1, .sharpness = side * corner.sharpness}};
  if (arc > kStraight) {
    segments.push_back({.length = arc, .curvature = side * corner.curvature});
  }
  segments.push_back({.length = ramp,
                      .curvature = side * corner.curvature,
                      .direction = 1,
                      .sharpness = -side * corner.sharpness});
  return segments;
}

/// Joins straights and rounded corners to a path and stores the station of each corner.
Path LayOut(const std::vector<Vec2>& polyline, std::vector<RoundCorner>& corners) {
  std::vector<Segment> segments;
  double station = 0.0;
  const auto add = [&](const Segment& segment) {
    segments.push_back(segment);
    station += segment.length;
  };
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    const double before = i == 0 ? 0.0 : corners[i - 1].tangent_length;
    const double after = i + 2 == polyline.size() ? 0.0 : corners[i].tangent_length;
    const double straight = (polyline[i + 1] - polyline[i]).norm() - before - after;
    if (straight > kStraight) {
      add({.length = straight});
    }
    if (i + 2 < polyline.size()) {
      RoundCorner& corner = corners[i];
      corner.from = station;
      if (corner.tangent_length > 0.0) {
        for (const Segment& segment : ToSegments(corner)) {
          add(segment);
        }
      }
      corner.to = station;
    }
  }
  return {StartOfRoute(polyline), std::move(segments)};
}

/// Returns the highest speed, at most `highest`, at which the car can drive the first corner. The
/// corner's tangent and the braking distance must both fit on the first leg, which is `leg` [m]
/// long. Returns nullopt if at no speed both the tangent and the braking distance fit.
template <typename Tangent>
std::optional<double> SpeedAfterBraking(const CornerLimits& limits, double highest, double leg,
                                        const Tangent& tangent) {
  const auto lacks = [&](double v) {
    const double braking = std::max(0.0, limits.start_speed * limits.start_speed - v * v) /
                           (2.0 * limits.deceleration);
    return tangent(v) + braking - leg;
  };
  if (lacks(highest) <= 0.0) {
    return highest;
  }
  // Try speeds one by one instead of by bisection: a lower corner speed shortens the curve but
  // lengthens the braking distance, so the condition is not monotonic in the speed.
  constexpr int kSteps = 100;
  for (int i = kSteps - 1; i >= 0; --i) {
    const double v = std::lerp(limits.min_speed, highest, static_cast<double>(i) / kSteps);
    if (lacks(v) <= 0.0) {
      return v;
    }
  }
  return std::nullopt;
}

std::string DescribePlace(const RoundCorner& corner) {
  return fmt::format("the corner of {:.3g} rad at ({:.4g}, {:.4g})", corner.heading_change,
                     corner.at.x(), corner.at.y());
}

/// Describes a waypoint that the slowest possible curve misses by more than `max_gap` [m].
std::string DescribeMiss(const RoundCorner& slowest, std::size_t waypoint, double max_gap) {
  return fmt::format(
      "{} is missed by {:.4g} m, more than {:.4g} m: the turn of {:.3g} deg there is rounded with "
      "a "
      "radius of {:.3g} m and steering ramps at {:.3g} m/s; {}",
      DescribeWaypoint(waypoint, slowest.at), slowest.gap, max_gap,
      slowest.heading_change * 180.0 / kPi, 1.0 / slowest.curvature, slowest.speed,
      RemedyForMiss(slowest.gap));
}

/// Returns the corner nearest to a station, or null if the path has no corner or the nearest corner
/// already has the minimum speed.
RoundCorner* CornerToSlow(std::vector<RoundCorner>& corners, double station, double min_speed) {
  RoundCorner* nearest = nullptr;
  const auto away = [&](const RoundCorner& corner) {
    return std::max({corner.from - station, station - corner.to, 0.0});
  };
  for (RoundCorner& corner : corners) {
    if (corner.tangent_length > 0.0 && (nearest == nullptr || away(corner) < away(*nearest))) {
      nearest = &corner;
    }
  }
  return nearest != nullptr && nearest->speed > min_speed ? nearest : nullptr;
}

}  // namespace

RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature) {
  const double h = std::abs(heading_change);
  TRACKBED_CHECK(h > 0.0 && h < kPi && speed > 0.0, "a corner of {} rad at {} m/s", heading_change,
                 speed);
  TRACKBED_CHECK(max_curvature > 0.0, "a corner of {} 1/m at most", max_curvature);
  RoundCorner corner;
  corner.heading_change = heading_change;
  corner.speed = speed;
  corner.sharpness = vehicle.steering_rate / (vehicle.wheelbase * speed);
  corner.curvature = std::min(std::sqrt(h * corner.sharpness), max_curvature);
  // By symmetry, the middle of the curve lies on the bisector of the corner.
  std::vector<Segment> half = ToSegments(corner);
  const bool has_arc = half.size() == 3;
  half.pop_back();
  if (has_arc) {
    half.back().length *= 0.5;
  }
  const Path path({}, std::move(half));
  const Vec2 middle = path.At(path.length()).pose.position();
  corner.tangent_length = middle.x() + std::abs(middle.y()) * std::tan(0.5 * h);
  // The curve is convex, so its point on the bisector is nearest to the corner.
  corner.gap = std::abs(middle.y()) / std::cos(0.5 * h);
  return corner;
}

namespace {

RoundCorner AtSpeed(const VehicleParams& vehicle, const CornerLimits& limits,
                    const RoundCorner& corner, double speed) {
  RoundCorner slower = CornerAt(vehicle, corner.heading_change, speed, limits.max_curvature);
  slower.at = corner.at;
  return slower;
}

/// Returns the index of the waypoint at a corner whose distance from the curve is limited; nullopt
/// if there is no such waypoint.
std::optional<std::size_t> WaypointAt(const CornerLimits& limits, const Vec2& corner) {
  constexpr double kAtWaypoint = 1e-6;  // [m]
  if (limits.max_gap == std::numeric_limits<double>::infinity()) {
    return std::nullopt;
  }
  for (std::size_t i = 1; i < limits.waypoints.size(); ++i) {
    if ((limits.waypoints[i] - corner).norm() < kAtWaypoint) {
      return i;
    }
  }
  return std::nullopt;
}

/// Returns the highest speed within the limits at which `excess` is not positive. The function
/// `excess` grows with the speed and is not positive at the lowest speed.
template <typename Excess>
double HighestSpeed(const CornerLimits& limits, const Excess& excess) {
  constexpr double kClose = 1e-6;  // [m/s]
  return excess(limits.speed) <= 0.0
             ? limits.speed
             : boost::math::tools::bisect(excess, limits.min_speed, limits.speed,
                                          [](double a, double b) { return b - a < kClose; })
                   .first;
}

/// Lays out the path and slows down corners until the path is clear of obstacles. Returns an error
/// message on failure, otherwise an empty text.
std::string SlowUntilClear(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                           const CornerLimits& limits, const CollisionChecker& clear,
                           RoundedCorners& result) {
  for (;;) {
    result.path = LayOut(polyline, result.corners);
    const std::optional<double> blocked = clear.FirstBlocked(result.path);
    if (!blocked) {
      return "";
    }
    RoundCorner* corner = CornerToSlow(result.corners, *blocked, limits.min_speed);
    if (corner == nullptr) {
      const Vec2 at = result.path.At(*blocked).pose.position();
      return fmt::format("the rounded path is too close to an obstacle at ({:.4g}, {:.4g})", at.x(),
                         at.y());
    }
    constexpr double kSpeedRatio = 0.8;
    *corner =
        AtSpeed(vehicle, limits, *corner, std::max(kSpeedRatio * corner->speed, limits.min_speed));
  }
}

}  // namespace

RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear) {
  TRACKBED_CHECK(polyline.size() >= 2, "{} points", polyline.size());
  RoundedCorners result;
  const auto refuse = [&](PlanStatus status, const std::string& reason) {
    result = {};
    result.status = status;
    result.reason = reason;
    return result;
  };
  const auto at_speed = [&](const RoundCorner& corner, double speed) {
    return AtSpeed(vehicle, limits, corner, speed);
  };
  for (std::size_t i = 1; i + 1 < polyline.size(); ++i) {
    const Vec2 in = polyline[i] - polyline[i - 1];
    const Vec2 out = polyline[i + 1] - polyline[i];
    RoundCorner corner;
    corner.at = polyline[i];
    corner.speed = limits.speed;
    corner.heading_change = std::atan2(Cross(in, out), in.dot(out));
    if (std::abs(corner.heading_change) < kStraight) {
      result.corners.push_back(corner);
      continue;
    }
    const std::optional<std::size_t> waypoint = WaypointAt(limits, corner.at);
    const auto refuse_sharp = [&](PlanStatus status, const std::string& reason) {
      refuse(status, reason);
      result.sharp_corner = waypoint ? std::optional(i) : std::nullopt;
      return result;
    };
    if (std::abs(corner.heading_change) > kPi - kStraight) {
      return refuse_sharp(PlanStatus::kUTurn, DescribePlace(corner) + " turns back on itself");
    }
    const double room_out = out.norm() * (i + 2 == polyline.size() ? 1.0 : 0.5);
    const double room_in = in.norm() * (i == 1 ? 1.0 : 0.5);
    const double max_gap = waypoint ? limits.max_gap : std::numeric_limits<double>::infinity();
    const RoundCorner slowest = at_speed(corner, limits.min_speed);
    if (slowest.tangent_length > std::min(room_in, room_out)) {
      return refuse_sharp(
          PlanStatus::kTurnTooTight,
          fmt::format("{} needs {:.3g} m of its legs even at {:.3g} m/s; available {:.3g}",
                      DescribePlace(corner), slowest.tangent_length, limits.min_speed,
                      std::min(room_in, room_out)));
    }
    if (slowest.gap > max_gap) {
      return refuse_sharp(PlanStatus::kWaypointMissed, DescribeMiss(slowest, *waypoint, max_gap));
    }
    double speed = HighestSpeed(limits, [&](double v) {
      const RoundCorner at = at_speed(corner, v);
      return std::max(at.tangent_length - std::min(room_in, room_out), at.gap - max_gap);
    });
    if (i == 1) {
      const auto slowed = SpeedAfterBraking(
          limits, speed, room_in, [&](double v) { return at_speed(corner, v).tangent_length; });
      if (!slowed) {
        return refuse(
            PlanStatus::kTurnTooTight,
            fmt::format("{} is too close to slow down for from {:.3g} m/s at {:.3g} m/s^2",
                        DescribePlace(corner), limits.start_speed, limits.deceleration));
      }
      speed = *slowed;
    }
    result.corners.push_back(at_speed(corner, speed));
  }
  if (const std::string blocked = SlowUntilClear(vehicle, polyline, limits, clear, result);
      !blocked.empty()) {
    return refuse(PlanStatus::kCollides, blocked);
  }
  for (const RoundCorner& corner : result.corners) {
    if (corner.speed < limits.speed) {
      result.caps.push_back({corner.from, corner.to, corner.speed});
    }
  }
  return result;
}

namespace {

/// Returns the polyline without points that lie on a straight, and without points whose neighbors
/// see each other according to `sees`.
template <typename Sees>
std::vector<Vec2> Without(const std::vector<Vec2>& polyline, const Sees& sees) {
  if (polyline.size() < 3) {
    return polyline;
  }
  std::vector<Vec2> kept{polyline.front()};
  for (std::size_t i = 1; i + 1 < polyline.size(); ++i) {
    const Vec2 in = polyline[i] - kept.back();
    const Vec2 out = polyline[i + 1] - polyline[i];
    constexpr double kRounding = 1e-12;
    const bool straight_on =
        std::abs(Cross(in, out)) <= kRounding * in.norm() * out.norm() && in.dot(out) > 0.0;
    if (!straight_on && !sees(kept.back(), polyline[i + 1])) {
      kept.push_back(polyline[i]);
    }
  }
  kept.push_back(polyline.back());
  return kept;
}

}  // namespace

std::vector<Vec2> WithoutCollinearPoints(const std::vector<Vec2>& polyline) {
  return Without(polyline, [](const Vec2&, const Vec2&) { return false; });
}

std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           const Inflation& inflation) {
  const BoxIndex index(boxes);
  return Without(polyline, [&](const Vec2& from, const Vec2& to) {
    return index.KeepsFrom(from, to, inflation);
  });
}

void Visit(DiagnosticsVisitor& out, const RoundCorner& corner) {
  out.Point("at_m", corner.at);
  out.Number("heading_change_rad", corner.heading_change);
  out.Number("speed_mps", corner.speed);
  out.Number("curvature_radpm", corner.curvature);
  out.Number("tangent_length_m", corner.tangent_length);
  out.Number("from_s_m", corner.from);
  out.Number("to_s_m", corner.to);
}

}  // namespace trackbed

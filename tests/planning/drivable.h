#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Checks a plan every 5 ms, independently of the planner's code. Computes positions from s and d;
/// headings, curvatures and rates from finite differences; clearances with Boost.Geometry; and
/// distances to the road edges by projecting the corners of the footprint.
inline void ExpectDrivable(const Path& path, const FrenetRequest& request,
                           const FrenetLimits& limits, const FrenetPlan& plan,
                           double until = std::numeric_limits<double>::infinity()) {
  namespace bg = boost::geometry;
  using Point = bg::model::d2::point_xy<double>;
  using Polygon = bg::model::polygon<Point, false, true>;
  const auto polygon_of = [](const OrientedBox& box) {
    Polygon polygon;
    for (const Vec2& corner : box.Corners()) {
      polygon.outer().emplace_back(corner.x(), corner.y());
    }
    polygon.outer().push_back(polygon.outer().front());
    return polygon;
  };
  const VehicleParams& car = request.vehicle;
  const double tightest = std::tan(car.steering_limit) / car.wheelbase;
  const double fastest = request.speed.speed * (1.0 + limits.speed_tolerance);
  // The largest motion of the front corner between two samples. Largest motion of the front corner
  // of the car between two samples.
  const double moves = limits.spacing * (1.0 + 3.7 * tightest);
  constexpr double kStep = 5e-3;
  constexpr double kDifference = 1e-3;
  struct Now {
    Vec2 position;
    double yaw;
    double speed;
  };
  const auto position_at = [&](double t) -> Vec2 {
    const FrenetState state = plan.motion.At(t);
    const Pose2 at = path.At(state.s).pose;
    return at.position() + state.d * LeftNormal(Direction(at.yaw));
  };
  const auto now_at = [&](double t) -> Now {
    const Vec2 velocity =
        (position_at(t + kDifference) - position_at(t - kDifference)) / (2.0 * kDifference);
    return {position_at(t), std::atan2(velocity.y(), velocity.x()), velocity.norm()};
  };
  std::vector<double> steered;  // steering angles of all steps since the car started to move
  const double end = std::min(until, plan.motion.duration() - kStep);
  for (double t = kStep; t < end; t += kStep) {
    const Now before = now_at(t - kDifference);
    const Now now = now_at(t);
    const Now after = now_at(t + kDifference);
    SCOPED_TRACE("at " + std::to_string(t) + " s");
    // The limited quantities may change by 1 % between two samples.
    EXPECT_LE(now.speed, 1.01 * fastest);
    const double acceleration = (after.speed - before.speed) / (2.0 * kDifference);
    EXPECT_LE(acceleration, 1.03 * request.speed.acceleration);
    EXPECT_GE(acceleration, -1.03 * request.speed.deceleration);
    if (now.speed < 0.1) {
      steered.clear();  // Differences give no heading at this speed.
      continue;
    }
    const double curvature =
        AngleDifference(after.yaw, before.yaw) / (2.0 * kDifference * now.speed);
    EXPECT_LE(std::abs(curvature), 1.01 * tightest);
    EXPECT_LE(now.speed * now.speed * std::abs(curvature), 1.01 * limits.max_lateral_acceleration);
    // If the sharpness of the path jumps, the curvature changes slightly between samples.
    steered.push_back(std::atan(car.wheelbase * curvature));
    const double step = std::min(limits.time_step, limits.spacing / now.speed);
    const auto window = static_cast<std::size_t>(std::ceil(step / kStep));
    if (steered.size() > window) {
      const double turned = steered.back() - steered[steered.size() - 1 - window];
      EXPECT_LE(std::abs(turned), 1.08 * car.steering_rate * kStep * static_cast<double>(window));
    }
    const double ahead = 0.5 * car.length - car.rear_overhang;
    const Vec2 middle = now.position + ahead * Direction(now.yaw);
    const OrientedBox footprint{{middle.x(), middle.y(), now.yaw}, car.length, car.width};
    for (const MovingBox& obstacle : request.obstacles) {
      OrientedBox box = obstacle.box;
      box.center.x += t * obstacle.velocity.x();
      box.center.y += t * obstacle.velocity.y();
      EXPECT_GE(bg::distance(polygon_of(footprint), polygon_of(box)),
                limits.safe_distance - 0.5 * (moves + step * obstacle.velocity.norm()));
    }
    const double s = plan.motion.At(t).s;
    for (const Vec2& corner : footprint.Corners()) {
      const double d = path.Project({corner.x(), corner.y(), 0.0}, {s - 6.0, s + 6.0}).cross_track;
      // The path is not exactly a circle over the length of the car. A sharpness of 0.002 1/m^2
      // adds an offset of up to 0.002 x 3.7^3/6 = 0.017 m.
      EXPECT_LE(d, request.road.left + 0.02 + 0.5 * moves);
      EXPECT_GE(d, -request.road.right - 0.02 - 0.5 * moves);
    }
    if (testing::Test::HasFailure()) {
      return;
    }
  }
}

}  // namespace trackbed

#pragma once

#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Goal pose relative to the start, in units of the radius. Sine and cosine of the goal's heading
/// are computed once for all Dubins or Reeds-Shepp words.
struct CurveGoal {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  double sin = 0.0;
  double cos = 1.0;

  CurveGoal() = default;
  CurveGoal(const Pose2& from, const Pose2& to, double radius) {
    TRACKBED_CHECK(radius > 0.0 && std::isfinite(radius), "radius {}", radius);
    const Vec2 local = ToLocal(from, to.position()) / radius;
    constexpr double kMaxDistance = 1e100;  // [radii]; its square is finite
    TRACKBED_REQUIRE(local.norm() <= kMaxDistance && std::isfinite(to.yaw - from.yaw),
                     "a curve from {}, {}, yaw {} to {}, {}, yaw {}; must be finite", from.x,
                     from.y, from.yaw, to.x, to.y, to.yaw);
    x = local.x();
    y = local.y();
    yaw = to.yaw - from.yaw;
    sin = std::sin(yaw);
    cos = std::cos(yaw);
  }

  /// Mirrors the goal at the x axis, which exchanges left and right.
  [[nodiscard]] CurveGoal Mirrored() const {
    CurveGoal goal = *this;
    goal.y = -y;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// Reflects the goal at the y axis, for a car that drives a Dubins or Reeds-Shepp word in the
  /// opposite direction.
  [[nodiscard]] CurveGoal Reversed() const {
    CurveGoal goal = *this;
    goal.x = -x;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// The start relative to the goal, for Reeds-Shepp words that the car drives from their end.
  [[nodiscard]] CurveGoal FromGoal() const {
    CurveGoal goal = *this;
    goal.x = x * cos + y * sin;
    goal.y = x * sin - y * cos;
    return goal;
  }
};

}  // namespace trackbed

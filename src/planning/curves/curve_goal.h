#pragma once

#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Goal pose relative to the start pose, with lengths in units of the turning radius. Sine and
/// cosine of the goal's heading are computed once for all Dubins or Reeds-Shepp words.
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
    // Upper bound of distances in turning radii, small enough that its square is finite.
    constexpr double kMaxDistance = 1e100;
    TRACKBED_REQUIRE(local.norm() <= kMaxDistance && std::isfinite(to.yaw - from.yaw),
                     "a curve from {}, {}, yaw {} to {}, {}, yaw {}; must be finite", from.x,
                     from.y, from.yaw, to.x, to.y, to.yaw);
    x = local.x();
    y = local.y();
    yaw = to.yaw - from.yaw;
    sin = std::sin(yaw);
    cos = std::cos(yaw);
  }

  /// Returns the goal mirrored at the x axis, which exchanges left and right.
  [[nodiscard]] CurveGoal Mirrored() const {
    CurveGoal goal = *this;
    goal.y = -y;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// Returns the goal mirrored at the y axis. A word to the mirrored goal becomes a word to the
  /// original goal if forward and reverse are exchanged.
  [[nodiscard]] CurveGoal Reversed() const {
    CurveGoal goal = *this;
    goal.x = -x;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// Returns the pose that a Reeds-Shepp word to this goal reaches if the pieces of the word are
  /// driven in the opposite order.
  [[nodiscard]] CurveGoal FromGoal() const {
    CurveGoal goal = *this;
    goal.x = x * cos + y * sin;
    goal.y = x * sin - y * cos;
    return goal;
  }
};

}  // namespace trackbed

#pragma once

#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Where a curve is to lead, as seen from its start, in radii. The sine and cosine of the heading
/// are there once for all the words.
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
    constexpr double kFarthest = 1e100;  // [radii]; their squares are numbers
    TRACKBED_REQUIRE(local.norm() <= kFarthest && std::isfinite(to.yaw - from.yaw),
                     "a curve from {}, {}, yaw {} to {}, {}, yaw {}; must be finite", from.x,
                     from.y, from.yaw, to.x, to.y, to.yaw);
    x = local.x();
    y = local.y();
    yaw = to.yaw - from.yaw;
    sin = std::sin(yaw);
    cos = std::cos(yaw);
  }

  /// As seen in a mirror along the x axis: left is right.
  [[nodiscard]] CurveGoal Mirrored() const {
    CurveGoal goal = *this;
    goal.y = -y;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// For a car that goes the other way along its x axis: forwards is backwards.
  [[nodiscard]] CurveGoal Reversed() const {
    CurveGoal goal = *this;
    goal.x = -x;
    goal.yaw = -yaw;
    goal.sin = -sin;
    return goal;
  }

  /// The start as seen from the goal by a car that drives the word from its end.
  [[nodiscard]] CurveGoal FromItsEnd() const {
    CurveGoal goal = *this;
    goal.x = x * cos + y * sin;
    goal.y = x * sin - y * cos;
    return goal;
  }
};

}  // namespace trackbed

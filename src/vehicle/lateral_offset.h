#pragma once

#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Moves a pose by `left` [m] to its left, without turning it. Throws PreconditionError unless
/// `left` is finite.
inline void ApplyLateralOffsetTo(Pose2& pose, double left) {
  TRACKBED_REQUIRE(std::isfinite(left), "ApplyLateralOffset: {} m; must be finite", left);
  const Vec2 to = ToWorld(pose, {0.0, left});
  pose.x = to.x();
  pose.y = to.y();
}

}  // namespace trackbed

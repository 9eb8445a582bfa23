#pragma once

#include <gtest/gtest.h>

#include "tests/tolerance.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Expects that two points differ by at most `tolerance` in each coordinate [m].
inline void ExpectNear(const Vec2& actual, const Vec2& expected, double tolerance) {
  EXPECT_NEAR(actual.x(), expected.x(), Tolerance(tolerance));
  EXPECT_NEAR(actual.y(), expected.y(), Tolerance(tolerance));
}

/// Expects that two poses differ by at most `tolerance` in each coordinate [m] and in yaw [rad].
/// Yaw angles that differ by a whole turn are not near.
inline void ExpectNear(const Pose2& actual, const Pose2& expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, Tolerance(tolerance));
  EXPECT_NEAR(actual.y, expected.y, Tolerance(tolerance));
  EXPECT_NEAR(actual.yaw, expected.yaw, Tolerance(tolerance));
}

}  // namespace trackbed

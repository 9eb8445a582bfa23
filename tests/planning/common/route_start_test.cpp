#include "trackbed/planning/common/route_start.h"

#include <gtest/gtest.h>

#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

TEST(StartOfRoute, IsAtTheFirstWaypointAlongTheFirstLeg) {
  EXPECT_EQ(StartOfRoute({{1.0, 2.0}, {1.0, 5.0}, {9.0, 9.0}}), (Pose2{1.0, 2.0, 0.5 * kPi}));
  EXPECT_EQ(StartOfRoute({{1.0, 2.0}, {-4.0, 2.0}}), (Pose2{1.0, 2.0, kPi}));
}

TEST(StartOfRoute, HasNoHeadingWithoutALeg) {
  EXPECT_EQ(StartOfRoute({Vec2(1.0, 2.0)}), (Pose2{1.0, 2.0, 0.0}));
  EXPECT_EQ(StartOfRoute({}), Pose2{});
}

}  // namespace
}  // namespace trackbed

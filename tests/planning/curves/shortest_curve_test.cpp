#include "trackbed/planning/curves/shortest_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/poses.h"
#include "tests/planning/shortest_curves.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

namespace trackbed {
namespace {

ShortestCurve Parking() {
  return {.radius = 5.0,
          .pieces = {{{Bend::kLeft, 0.5}, {Bend::kRight, -0.7}, {Bend::kNone, -2.0}}},
          .count = 3,
          .length = 16.0};
}

TEST(ShortestCurve, IsRefusedToAndFromPosesThatAreNoNumbers) {
  for (const double bad : {std::nan(""), HUGE_VAL, 1e308}) {
    EXPECT_THROW(ReedsShepp({}, {9.0, 1.0, bad == 1e308 ? HUGE_VAL : bad}, 5.0), PreconditionError);
    EXPECT_THROW(ReedsShepp({bad, 0.0, 0.0}, {}, 5.0), PreconditionError);
    EXPECT_THROW(Dubins({}, {bad, 1.0, 0.0}, 5.0), PreconditionError);
  }
}

TEST(ShortestCurve, IsSpelledWithItsDirections) {
  EXPECT_EQ(CurveWord(Parking()), "L+R-S-");
  EXPECT_EQ(CurveWord({}), "");
}

TEST(ShortestCurve, IsAPathOfTheSameLengthAndEnd) {
  const Pose2 start{3.0, -2.0, 0.4};
  const Path path(start, ToSegments(Parking()));
  // The tolerance allows for rounding in sums of a few tens of meters.
  EXPECT_NEAR(path.length(), Parking().length, Tolerance(1e-12));
  EXPECT_NEAR(Apart(path.At(path.length()).pose, EndPose(start, Parking())), 0.0, Tolerance(1e-12));
  ASSERT_EQ(path.segments().size(), 3U);
  EXPECT_EQ(path.segments()[1].direction, -1);
  EXPECT_EQ(path.segments()[1].curvature, -0.2);
  // An arc to the right, driven in reverse, turns the car to the left.
  EXPECT_NEAR(path.At(path.length()).pose.yaw, 0.4 + 0.5 + 0.7, Tolerance(1e-12));
}

TEST(ShortestCurve, LeavesOutWhatIsOnlyRounding) {
  ShortestCurve curve = Parking();
  curve.pieces[1].sweep = 1e-14;
  EXPECT_EQ(ToSegments(curve).size(), 2U);
  EXPECT_EQ(CurveWord(curve), "L+S-");
}

}  // namespace
}  // namespace trackbed

#include "trackbed/planning/curves/dubins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/poses.h"
#include "tests/planning/shortest_curves.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// The accuracy of the end pose that the header guarantees [m, rad].
constexpr double kEnd = 1e-9;

TEST(Dubins, ReachesEveryPoseByEveryWord) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = RandomPose(random, 20.0);
    const Pose2 to = RandomPose(random, 20.0);
    const double radius = random.Uniform(0.5, 12.0);
    const auto words = DubinsWords(from, to, radius);
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(Dubins(from, to, radius).length, words.front().length);
    for (const ShortestCurve& word : words) {
      ASSERT_LE(Apart(EndPose(from, word), to), Tolerance(kEnd)) << CurveWord(word);
      for (const Segment& segment : ToSegments(word)) {
        ASSERT_EQ(segment.direction, 1);
      }
    }
  }
}

TEST(Dubins, ReachesPosesWhereTangentsTouch) {
  for (const Pose2& to : DegeneratePoses()) {
    const ShortestCurve curve = Dubins({}, to, 1.0);
    ASSERT_LE(Apart(EndPose({}, curve), to), Tolerance(kEnd))
        << CurveWord(curve) << " to " << to.x << ", " << to.y << ", " << to.yaw;
    // The curve is at least as long as the straight line, and at most two full circles longer.
    EXPECT_GE(curve.length, to.position().norm() - Tolerance(1e-12));
    EXPECT_LE(curve.length, to.position().norm() + 4.0 * kPi);
  }
}

TEST(Dubins, FindsWhatIsPlain) {
  const double pi = kPi;
  const auto length = [](const Pose2& to) { return Dubins({}, to, 2.0).length; };
  const double rounding = Tolerance(1e-12);
  EXPECT_NEAR(length({}), 0.0, rounding);
  EXPECT_NEAR(length({7.0, 0.0, 0.0}), 7.0, rounding);
  EXPECT_NEAR(length({2.0, 2.0, 0.5 * pi}), pi, rounding);   // A quarter circle to the left.
  EXPECT_NEAR(length({0.0, -4.0, pi}), 2.0 * pi, rounding);  // Half a circle to the right.
  // A goal slightly behind the car needs a full circle.
  EXPECT_NEAR(length({-1e-3, 0.0, 0.0}), 4.0 * pi, 1e-2);
  // To turn around in place, the car drives arcs of pi/3, 5 pi/3 and pi/3 on three circles that
  // touch each other.
  EXPECT_NEAR(length({0.0, 0.0, pi}), 2.0 * pi * 7.0 / 3.0, rounding);
  EXPECT_EQ(CurveWord(Dubins({}, {0.0, 0.0, pi}, 2.0)).size(), 6U);
}

TEST(Dubins, MirrorsAndRunsBackwards) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Pose2 from = RandomPose(random, 8.0);
    const Pose2 to = RandomPose(random, 8.0);
    const ShortestCurve curve = Dubins(from, to, 1.5);
    // The tolerance allows for sums of at most 40 m that are rounded in another order.
    const double rounding = Tolerance(1e-11);
    const ShortestCurve mirrored = Dubins(Mirror(from), Mirror(to), 1.5);
    EXPECT_NEAR(mirrored.length, curve.length, rounding);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(mirrored.pieces[k].sweep, curve.pieces[k].sweep, rounding);
      EXPECT_EQ(static_cast<int>(mirrored.pieces[k].bend), -static_cast<int>(curve.pieces[k].bend));
    }
    EXPECT_NEAR(Dubins(TurnedRound(to), TurnedRound(from), 1.5).length, curve.length, rounding);
    const Pose2 moved{-40.0, 25.0, 1.1};
    EXPECT_NEAR(Dubins(Compose(moved, from), Compose(moved, to), 1.5).length, curve.length,
                rounding);
    EXPECT_NEAR(
        Dubins({3.0 * from.x, 3.0 * from.y, from.yaw}, {3.0 * to.x, 3.0 * to.y, to.yaw}, 4.5)
            .length,
        3.0 * curve.length, 3.0 * rounding);
  }
}

TEST(Dubins, RefusesRadiiThatAreNone) {
  EXPECT_THROW(Dubins({}, {1.0, 0.0, 0.0}, 0.0), InternalError);
  EXPECT_THROW(DubinsWords({}, {1.0, 0.0, 0.0}, -1.0), InternalError);
}

}  // namespace
}  // namespace trackbed

#include "trackbed/planning/curves/reeds_shepp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/planning/poses.h"
#include "tests/planning/shortest_curves.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/curves/dubins.h"

namespace trackbed {
namespace reeds_shepp_test {

/// The accuracy of the end pose that the header guarantees [m, rad].
constexpr double kEnd = 1e-9;

TEST(ReedsShepp, ReachesEveryPoseByEveryWord) {
  Random random(1);
  std::set<std::string> shortest;
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = RandomPose(random, i % 2 == 0 ? 20.0 : 2.0);
    const Pose2 to = RandomPose(random, i % 2 == 0 ? 20.0 : 2.0);
    const double radius = random.Uniform(0.5, 12.0);
    const auto words = ReedsSheppWords(from, to, radius);
    ASSERT_FALSE(words.empty());
    const ShortestCurve curve = ReedsShepp(from, to, radius);
    EXPECT_EQ(curve.length, words.front().length);
    EXPECT_EQ(ReedsSheppLength(from, to, radius), curve.length);
    shortest.insert(CurveWord(curve));
    for (const ShortestCurve& word : words) {
      ASSERT_LE(Apart(EndPose(from, word), to), Tolerance(kEnd)) << CurveWord(word);
      double sum = 0.0;
      for (const Segment& segment : ToSegments(word)) {
        sum += segment.length;
      }
      ASSERT_NEAR(sum, word.length, Tolerance(1e-9));
    }
  }
  // Each of the 48 words of Reeds and Shepp (1990) is the shortest for some pose.
  EXPECT_EQ(shortest.size(), 48U);
}

TEST(ReedsShepp, ReachesPosesWhereTangentsTouch) {
  for (const Pose2& to : DegeneratePoses()) {
    const ShortestCurve curve = ReedsShepp({}, to, 1.0);
    ASSERT_LE(Apart(EndPose({}, curve), to), Tolerance(kEnd))
        << CurveWord(curve) << " to " << to.x << ", " << to.y << ", " << to.yaw;
  }
}

TEST(ReedsShepp, IsADistanceBetweenPoses) {
  // The length must be symmetric and satisfy the triangle inequality. At degenerate poses, pieces
  // of a word vanish, so a missing word would violate the inequality.
  Random random(3);
  for (const Pose2& to : DegeneratePoses()) {
    const double direct = ReedsSheppLength({}, to, 1.0);
    EXPECT_NEAR(ReedsSheppLength(to, {}, 1.0), direct, Tolerance(1e-9));
    for (int i = 0; i < 20; ++i) {
      const Pose2 off{random.Uniform(-1e-3, 1e-3), random.Uniform(-1e-6, 1e-6),
                      random.Uniform(-1e-3, 1e-3)};
      const Pose2 via = i % 2 == 0 ? Compose(to, off) : RandomPose(random, 5.0);
      ASSERT_LE(direct,
                ReedsSheppLength({}, via, 1.0) + ReedsSheppLength(via, to, 1.0) + Tolerance(1e-9))
          << "to " << to.x << ", " << to.y << ", " << to.yaw;
    }
  }
}

TEST(ReedsShepp, IsNeverLongerThanDubins) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Pose2 to = RandomPose(random, 6.0);
    EXPECT_LE(ReedsSheppLength({}, to, 1.3), Dubins({}, to, 1.3).length + Tolerance(1e-11));
  }
}

TEST(ReedsShepp, FindsWhatIsPlain) {
  const double rounding = Tolerance(1e-12);
  const auto length = [](const Pose2& to) { return ReedsSheppLength({}, to, 2.0); };
  EXPECT_NEAR(length({}), 0.0, rounding);
  EXPECT_NEAR(length({-7.0, 0.0, 0.0}), 7.0, rounding);         // straight backward
  EXPECT_NEAR(length({-2.0, 2.0, -0.5 * kPi}), kPi, rounding);  // a quarter circle backward
  EXPECT_NEAR(length({0.0, 0.0, kPi}), 2.0 * kPi, rounding);    // three arcs of pi/3
  EXPECT_EQ(CurveWord(ReedsShepp({}, {0.0, 0.0, kPi}, 2.0)).size(), 6U);
  // The car moves sideways into a gap on four arcs. The sweep u of each arc follows from the offset
  // y = 4 r (1 - cos u).
  const double u = std::acos(1.0 - 0.5 / (4.0 * 2.0));
  EXPECT_LE(length({0.0, 0.5, 0.0}), 2.0 * 4.0 * u);
}

TEST(ReedsShepp, MirrorsAndRunsBackwards) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Pose2 from = RandomPose(random, 8.0);
    const Pose2 to = RandomPose(random, 8.0);
    const double length = ReedsSheppLength(from, to, 1.5);
    const double rounding = Tolerance(1e-11);
    EXPECT_NEAR(ReedsSheppLength(Mirror(from), Mirror(to), 1.5), length, rounding);
    EXPECT_NEAR(ReedsSheppLength(to, from, 1.5), length, rounding);
    EXPECT_NEAR(ReedsSheppLength(TurnedRound(from), TurnedRound(to), 1.5), length, rounding);
    const Pose2 moved{-40.0, 25.0, 1.1};
    EXPECT_NEAR(ReedsSheppLength(Compose(moved, from), Compose(moved, to), 1.5), length, rounding);
  }
}

TEST(ReedsShepp, RefusesRadiiThatAreNone) {
  EXPECT_THROW(ReedsShepp({}, {1.0, 0.0, 0.0}, 0.0), InternalError);
}

}  // namespace reeds_shepp_test
}  // namespace trackbed

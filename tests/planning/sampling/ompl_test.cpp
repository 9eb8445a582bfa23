#include <gtest/gtest.h>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

#ifdef TRACKBED_OMPL
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#endif

// Compares the lengths of the shortest curves with those of OMPL, if OMPL is installed.
namespace trackbed {
namespace {

#ifdef TRACKBED_OMPL

template <typename Space, typename Length>
void Compare(double radius, const Length& length) {
  const auto space = std::make_shared<Space>(radius);
  ompl::base::ScopedState<Space> a(space);
  ompl::base::ScopedState<Space> b(space);
  const auto set = [](ompl::base::ScopedState<Space>& state, const Pose2& pose) {
    state->setXY(pose.x, pose.y);
    state->setYaw(WrapAngle(pose.yaw));
  };
  Random random(5);
  for (int i = 0; i < 100000; ++i) {
    // The poses are close to each other or far apart. Only close poses need words of many arcs.
    const double reach = i % 3 == 0 ? 30.0 : 3.0 * radius;
    const Pose2 from = RandomPose(random, reach);
    const Pose2 to = RandomPose(random, reach);
    set(a, from);
    set(b, to);
    ASSERT_NEAR(length(from, to, radius), space->distance(a.get(), b.get()), Tolerance(1e-6))
        << from.x << ", " << from.y << ", " << from.yaw << " to " << to.x << ", " << to.y << ", "
        << to.yaw;
  }
}

TEST(ShortestCurvesOfOmpl, HaveTheLengthOfOurDubins) {
  Compare<ompl::base::DubinsStateSpace>(
      5.1, [](const Pose2& a, const Pose2& b, double r) { return Dubins(a, b, r).length; });
}

TEST(ShortestCurvesOfOmpl, HaveTheLengthOfOurReedsShepp) {
  Compare<ompl::base::ReedsSheppStateSpace>(5.1, ReedsSheppLength);
}

#else

TEST(ShortestCurvesOfOmpl, HaveTheLengthOfOurs) {
  GTEST_SKIP() << "libompl-dev is not installed";
}

#endif

}  // namespace
}  // namespace trackbed

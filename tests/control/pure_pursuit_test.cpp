#include "trackbed/control/pure_pursuit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
#include "tests/control/steer_once.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"

namespace trackbed {
namespace {

double Steer(const PurePursuitOptions& options, const Path& path, const Pose2& pose, double speed) {
  return SteerOnce(options, path, pose, speed);
}

TEST(PurePursuit, SteersTheCircleThroughThePoint) {
  // The car is e = 1 m to the left of a straight, and the lookahead distance is l = 4 m. Therefore
  // sin(u) = -1/4, and the commanded curvature is -2 e/l^2 = -1/8 1/m.
  const Path straight({}, {{100.0, 0.0, 1}});
  EXPECT_NEAR(Steer({.distance = 4.0, .time = 0.0}, straight, {0.0, 1.0, 0.0}, 3.0),
              -std::atan(2.7 / 8.0), Tolerance(1e-11));
  // On a circle with the radius R = 20 m, the angle is atan(L/R) for any lookahead distance.
  const Path circle({}, {{100.0, 0.05, 1}});
  for (const double distance : {1.0, 4.0, 15.0}) {
    EXPECT_NEAR(Steer({.distance = distance, .time = 0.0}, circle, {}, 3.0), 0.134189,
                Tolerance(0.5e-6));
  }
}

TEST(PurePursuit, LooksFurtherAheadTheFasterItGoes) {
  const Path straight({}, {{100.0, 0.0, 1}});
  const PurePursuitOptions options{.distance = 4.0, .time = 0.8};
  const auto at = [&](double speed) { return Steer(options, straight, {0.0, 1.0, 0.0}, speed); };
  EXPECT_NEAR(at(2.0), -std::atan(2.0 * 2.7 / 16.0), Tolerance(1e-11));
  EXPECT_NEAR(at(20.0), -std::atan(2.0 * 2.7 / 256.0), Tolerance(1e-11));
}

TEST(PurePursuit, SwingsOutWhenItLooksTooNearForItsWheels) {
  // The header states the shortest lookahead distance without oscillation: 1.5 cbrt(e L v/omega),
  // which is 5.7 m for an offset of e = 1 m at 3 m/s.
  LoopSetup setup;
  setup.path = Path({}, {{300.0, 0.0, 1}});
  setup.start = {0.0, 1.0, 0.0};
  setup.duration = 60.0;
  const auto late = [&](double distance) {
    const auto rows = Loop(PurePursuitOptions{.distance = distance, .time = 0.0}, setup);
    return LargestOffset(rows, rows.size() / 2);
  };
  EXPECT_LT(late(5.7), 0.05);
  EXPECT_GT(late(2.0), 0.5);
}

}  // namespace
}  // namespace trackbed

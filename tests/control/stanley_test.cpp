#include "trackbed/control/stanley.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
#include "tests/control/steer_once.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"

namespace trackbed {
namespace stanley_test {

double Steer(const StanleyOptions& options, const Path& path, const Pose2& pose, double speed) {
  return SteerOnce(options, path, pose, speed);
}

TEST(Stanley, AddsHeadingAndOffsetOfTheFrontAxle) {
  const Path straight({}, {{100.0, 0.0, 1}});
  // With a cross-track error of 0.5 m to the left, a gain of 1 1/s, a softening of 1 m/s and a
  // speed of 3 m/s, the angle is -atan(1 * 0.5/(1 + 3)).
  EXPECT_NEAR(Steer({.gain = 1.0}, straight, {0.0, 0.5, 0.0}, 3.0), -std::atan(0.125),
              Tolerance(1e-12));
  // With a heading error of 0.1 rad to the left, the cross-track error of the front axle is L
  // sin(0.1).
  EXPECT_NEAR(Steer({.gain = 1.0}, straight, {0.0, 0.0, 0.1}, 3.0),
              -0.1 - std::atan(2.7 * std::sin(0.1) / 4.0), Tolerance(1e-12));
  // In reverse the law uses the cross-track error of the rear axle, and the heading error has the
  // opposite sign.
  const Path back({}, {{100.0, 0.0, -1}});
  EXPECT_NEAR(Steer({.gain = 1.0}, back, {0.0, 0.5, 0.1}, -3.0), 0.1 - std::atan(0.125),
              Tolerance(1e-12));
}

TEST(Stanley, FrontAxleReturnsExponentially) {
  // With the softening k_s = 0 and ideal wheels, the cross-track error of the front axle obeys e_f'
  // = -v sin(atan(k e_f/v)). The solution is 0.1 m exp(-k t), up to the third power of k e_f/v =
  // 0.03 and the effect of holding the angle for 1 ms.
  LoopSetup setup;
  setup.vehicle.steering_rate = 1e6;
  setup.path = Path({}, {{100.0, 0.0, 1}});
  setup.start = {0.0, 0.1, 0.0};
  setup.period = 0.001;
  setup.duration = 3.0;
  const std::vector<LoopRow> rows = Loop(StanleyOptions{.gain = 1.0, .softening = 0.0}, setup);
  for (const LoopRow& row : rows) {
    const double front = row.tracking.cross_track + 2.7 * std::sin(row.tracking.heading_error);
    EXPECT_NEAR(front, 0.1 * std::exp(-row.state.time), Tolerance(2e-4)) << row.state.time;
  }
}

TEST(Stanley, KeepsTheSingleTrackCarInASteadyTurn) {
  // The feed-forward includes understeer and the rear axle's slip.
  const VehicleParams car = ReferenceCarWithTyres();
  LoopSetup setup;
  setup.vehicle = car;
  setup.path = Path({}, {{.length = 20.0},
                         {.length = 30.0, .sharpness = 0.02 / 30.0},
                         {.length = 200.0, .curvature = 0.02}});
  setup.speed = 8.0;
  setup.duration = 25.0;
  const std::vector<LoopRow> rows = Loop(StanleyOptions{}, setup);
  EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 2e-3);
}

}  // namespace stanley_test
}  // namespace trackbed

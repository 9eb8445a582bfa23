#include "trackbed/control/rear_axle_feedback.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"

namespace trackbed {
namespace {

/// A car on a straight with ideal wheels; each angle is held for 1 ms.
LoopSetup IdealCar(int direction) {
  LoopSetup setup;
  setup.vehicle.steering_rate = 1e6;
  setup.path = Path({}, {{100.0, 0.0, direction}});
  setup.speed = direction * 3.0;
  setup.period = 0.001;
  setup.duration = 10.0;
  return setup;
}

double LyapunovFunction(const LoopRow& row, double d) {
  const double e = row.tracking.cross_track / d;
  const double psi = row.tracking.heading_error;
  return e * e + psi * psi;
}

class RearAxleFeedback : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, RearAxleFeedback, testing::Values(1, -1), kNamedByParameter);

TEST_P(RearAxleFeedback, SmallErrorsDecayCriticallyDamped) {
  // The cross-track error e obeys e'' = -2 e'/d - e/d^2, with derivatives by the distance s.
  // Starting at e_0 = 0.05 m parallel to the path, the solution is e = e_0 (1 + s/d) exp(-s/d). The
  // angle is held for 1 ms, which is 3 mm of s and adds e_0 (3 mm)/d = 2.5e-5 m. Terms of third
  // order add (e_0/d)^3 d = 3.5e-6 m.
  LoopSetup setup = IdealCar(GetParam());
  setup.start = {0.0, 0.05, 0.0};
  const double d = 6.0;
  for (const LoopRow& row : Loop(RearAxleFeedbackOptions{.distance = d}, setup)) {
    const double s = 3.0 * row.state.time / d;
    EXPECT_NEAR(row.tracking.cross_track, 0.05 * (1.0 + s) * std::exp(-s), Tolerance(3e-5))
        << row.state.time;
  }
}

TEST_P(RearAxleFeedback, LyapunovFunctionDoesNotGrowFromLargeErrors) {
  // The start at e = 6 m and psi = 1.2 rad needs the curvature 2 psi/d + e/d^2 = 0.135 1/m with d =
  // 20 m. This is within the steering limit, which allows 1/(5.1 m) = 0.196 1/m.
  LoopSetup setup = IdealCar(GetParam());
  setup.start = {0.0, 6.0, 1.2};
  const double d = 20.0;
  const std::vector<LoopRow> rows = Loop(RearAxleFeedbackOptions{.distance = d}, setup);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    // The commanded curvature kappa_c < 0.14 1/m is held over h = 3 mm, which adds a second-order
    // change of (h kappa_c)^2 < 2e-7.
    EXPECT_LE(LyapunovFunction(rows[i], d), LyapunovFunction(rows[i - 1], d) + 2e-7)
        << rows[i].state.time;
  }
  EXPECT_LT(LyapunovFunction(rows.back(), d), 0.3 * LyapunovFunction(rows.front(), d));
}

TEST_P(RearAxleFeedback, ParallelCurveIsAnEquilibriumOfTheHeading) {
  // At an offset e from a circle, with the heading of the circle, the first term alone keeps the
  // car on the parallel circle.
  const VehicleParams car = ReferenceCar();
  const Reference reference{
      Path({}, {{.length = 30.0, .curvature = 0.05, .direction = GetParam()}}), {}};
  VehicleState state;
  state.pose = {0.0, 2.0, 0.0};
  state.speed = 3.0 * GetParam();
  const double d = 1000.0;
  const double steering = MakeSteeringController(RearAxleFeedbackOptions{.distance = d})
                              ->Steer({.vehicle = car,
                                       .reference = reference,
                                       .schedule = {},
                                       .state = state,
                                       .station = 0.0,
                                       .period = 0.02});
  // The commanded curvature is kappa/(1 - kappa e) - e/d^2, with kappa = 0.05 1/m and e = 2 m.
  EXPECT_NEAR(std::tan(steering) / car.wheelbase, 0.05 / 0.9 - 2e-6, Tolerance(1e-12));
}

TEST(RearAxleFeedback, KeepsTheSingleTrackCarInASteadyTurn) {
  LoopSetup setup;
  setup.vehicle = ReferenceCarWithTyres();
  setup.path = Path({}, {{.length = 20.0},
                         {.length = 30.0, .sharpness = 0.02 / 30.0},
                         {.length = 200.0, .curvature = 0.02}});
  setup.speed = 8.0;
  setup.duration = 25.0;
  const std::vector<LoopRow> rows = Loop(RearAxleFeedbackOptions{}, setup);
  // The feed-forward includes understeer and the rear axle's slip, tan(beta) = 0.0087, to first
  // order in beta. The feed-forward neglects that the rear axle's speed is u/cos(beta), which is a
  // curvature error of kappa beta^2/2. With d = 5.5 m, this causes the cross-track error d^2 kappa
  // beta^2/2 = 2.3e-5 m. The feed-forward also neglects beta^3/3 in the slip angle, which causes
  // the cross-track error 2 d beta^3/3 = 2.4e-6 m.
  EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 2.6e-5);
}

TEST(RearAxleFeedback, ReturnsUnderTheRateLimitWithItsDefaults) {
  for (const double speed : {1.0, 3.0, 8.0}) {
    for (const double offset : {0.2, 1.0, 4.0}) {
      LoopSetup setup;
      setup.path = Path({}, {{400.0, 0.0, 1}});
      setup.start = {0.0, offset, 0.0};
      setup.speed = speed;
      setup.duration = 100.0 / speed + 20.0;
      const std::vector<LoopRow> rows = Loop(RearAxleFeedbackOptions{}, setup);
      EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 0.01) << speed << " " << offset;
      EXPECT_LT(LargestOffset(rows), 1.001 * offset) << speed << " " << offset;
    }
  }
}

}  // namespace
}  // namespace trackbed

#include "trackbed/control/rear_axle_feedback.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
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

INSTANTIATE_TEST_SUITE_P(Directions, RearAxleFeedback, testing::Values(1, -1));

TEST_P(RearAxleFeedback, SmallErrorsDecayCriticallyDamped) {
  // e'' = -2 e'/d - e/d^2 from e_0 at rest has the solution e = e_0 (1 + s/d) exp(-s/d). The angle
  // is held for 1 ms, 3 mm of s, which adds e_0 (3 mm)/d = 2.5e-5. Terms of third order are
  // (e_0/d)^3 d = 1e-6.
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
  // Within the steering limit: 2 psi/d + e/d^2 < tan(0.5)/L with d = 20 m.
  LoopSetup setup = IdealCar(GetParam());
  setup.start = {0.0, 6.0, 1.2};
  const double d = 20.0;
  const std::vector<LoopRow> rows = Loop(RearAxleFeedbackOptions{.distance = d}, setup);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    // Holding for h = 3 mm adds a second-order change of (h kappa_c)^2 with kappa_c < 0.14.
    EXPECT_LE(LyapunovFunction(rows[i], d), LyapunovFunction(rows[i - 1], d) + 2e-7)
        << rows[i].state.time;
  }
  EXPECT_LT(LyapunovFunction(rows.back(), d), 0.3 * LyapunovFunction(rows.front(), d));
}

TEST_P(RearAxleFeedback, ParallelCurveIsAnEquilibriumOfTheHeading) {
  // At offset e from a circle and parallel to it, the first term alone keeps the car on the
  // parallel circle.
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
  // kappa/(1 - kappa e) - e/d^2.
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
  // The feed-forward includes understeer and the rear axle's slip, tan(beta) = 0.0087, linear in
  // beta. Neglected: the rear axle's speed u/cos(beta), a curvature of kappa beta^2/2, which d =
  // 5.5 m turns into e = d^2 kappa beta^2/2 = 2.3e-5 m; and beta^3/3, which gives 2 d beta^3/3.
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

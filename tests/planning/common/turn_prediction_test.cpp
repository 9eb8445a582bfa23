#include "trackbed/planning/common/turn_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {
namespace {

constexpr double kSpeed = 3.0;

Plan MakeFilletPlan(const std::vector<Vec2>& route, double radius) {
  FilletOptions options;
  options.radius = radius;
  options.constraint = RadiusConstraint::kNone;
  return MakePlan({.vehicle = ReferenceCar(),
                   .waypoints = route,
                   .start_speed = kSpeed,
                   .speed = {.speed = kSpeed, .acceleration = 1.0, .deceleration = 1.5}},
                  options);
}

TEST(PredictTurn, DeficitIsTheClosedForm) {
  for (const double radius : {8.0, 12.0, 16.0}) {
    const Plan plan = MakeFilletPlan(RouteA(), radius);
    ASSERT_EQ(plan.turns.size(), 3U);
    const double delta = std::atan(2.7 / radius);
    const double ramp = kSpeed * delta * 17.6 / 2.65;
    const double ramp_heading = kSpeed * 17.6 / (2.7 * 2.65) * -std::log(std::cos(delta));
    const double lag = 0.05;
    for (const IsolatedTurn& turn : plan.turns) {
      const double sign = turn.steering > 0.0 ? 1.0 : -1.0;
      const TurnError none = PredictTurn(ReferenceCar(), plan.reference.path, turn, 0.0);
      EXPECT_NEAR(sign * none.heading_deficit, 0.5 * ramp / radius - ramp_heading,
                  Tolerance(1e-12));
      const TurnError late = PredictTurn(ReferenceCar(), plan.reference.path, turn, lag);
      EXPECT_NEAR(sign * (late.heading_deficit - none.heading_deficit), kSpeed * lag / radius,
                  Tolerance(1e-12));
    }
  }
}

TEST(PredictTurn, IsWhatTheRateLimitedCarDoes) {
  const Plan plan = MakeFilletPlan(RouteB(), 12.0);
  ASSERT_EQ(plan.turns.size(), 3U);
  const IsolatedTurn& turn = plan.turns[0];
  const Pose2 start = plan.reference.path.At(0.0).pose;
  const auto states = RollOut(ReferenceCar(), {.pose = start, .speed = kSpeed}, plan.schedule,
                              {turn.from, turn.middle}, 0.02);
  const TurnError driven = ErrorInTurn(plan.reference.path, turn, states[0].pose, states[1].pose);
  const TurnError predicted = PredictTurn(ReferenceCar(), plan.reference.path, turn, 0.0);
  // The tolerance is the error of the roll-out, which is a method of fourth order with steps of
  // 0.02 m.
  EXPECT_NEAR(driven.heading_deficit, predicted.heading_deficit, Tolerance(1e-10));
  EXPECT_NEAR(driven.lateral_offset, predicted.lateral_offset, Tolerance(1e-9));
}

TEST(PredictTurn, OffsetIsThatOfACenterdRampOnGentleTurns) {
  // If the heading on the ramp is quadratic in the station, as for small angles, the offset is
  // kappa S^2/24 to the inside of the turn, where S is the length of the ramp.
  const double radius = 60.0;
  const std::vector<Vec2> route{{0, 0}, {80, 0}, {150, 40}};
  const Plan plan = MakeFilletPlan(route, radius);
  ASSERT_EQ(plan.turns.size(), 1U);
  const double ramp = SteeringDistance(ReferenceCar(), std::atan(2.7 / radius), kSpeed);
  // The offset of the car from the path is largest at the end of the ramp. After the ramp, the
  // car's heading deficit moves the car outward again.
  IsolatedTurn turn = plan.turns[0];
  turn.middle = turn.from + ramp;
  const TurnError error = PredictTurn(ReferenceCar(), plan.reference.path, turn, 0.0);
  const double expected = ramp * ramp / (24.0 * radius);
  EXPECT_NEAR(error.lateral_offset, expected, Tolerance(0.01 * expected));
}

TEST(IsolatedTurns, LeaveOutTurnsThatCannotBePredicted) {
  EXPECT_TRUE(MakeFilletPlan(RouteA(), 5.1).turns.empty()) << "ramps that do not fit their arcs";
  EXPECT_EQ(MakeFilletPlan(RouteA(), 20.0).turns.size(), 1U)
      << "the wheels come back from the one before";
}

}  // namespace
}  // namespace trackbed

#include "trackbed/vehicle/steering_actuator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"

namespace trackbed {
namespace steering_actuator_test {

SteeringLimits Limits() {
  return {ReferenceCar().steering_limit, ReferenceCar().steering_rate};
}

// Two roundings of numbers below 4.
constexpr double kRounding = 1e-15;

TEST(MoveSteering, ReachesFullLockAfterLimitOverRate) {
  const SteeringMove move = MoveSteering(Limits(), 0.0, Limits().angle);
  EXPECT_NEAR(move.ramp_time, 3.2337, Tolerance(0.5e-4));  // limit/rate
  EXPECT_EQ(move.end, Limits().angle);
  EXPECT_EQ(move.At(4.0), Limits().angle);
}

TEST(MoveSteering, LeftIsPositive) {
  EXPECT_GT(MoveSteering(Limits(), 0.0, 0.1).rate, 0.0);
  EXPECT_LT(MoveSteering(Limits(), 0.0, -0.1).rate, 0.0);
}

TEST(MoveSteering, CutsWhatIsWantedToTheLimits) {
  EXPECT_EQ(MoveSteering(Limits(), 0.1, 10.0).end, Limits().angle);
  EXPECT_EQ(MoveSteering(Limits(), 0.1, -10.0).end, -Limits().angle);
}

TEST(MoveSteering, RampsAtTheFullRateThenRests) {
  const SteeringMove move = MoveSteering(Limits(), 0.2, -0.1);
  EXPECT_NEAR(move.ramp_time, 0.3 / Limits().rate, Tolerance(kRounding * 2.0));
  EXPECT_EQ(move.At(0.0), 0.2);
  EXPECT_NEAR(move.At(1.0), 0.2 - Limits().rate, Tolerance(kRounding));
  EXPECT_EQ(move.At(move.ramp_time), -0.1);
  EXPECT_EQ(move.At(1e9), -0.1);
  // The angle is continuous on arrival.
  EXPECT_NEAR(move.At(std::nextafter(move.ramp_time, 0.0)), -0.1, Tolerance(kRounding));
}

TEST(MoveSteering, StaysWhereItIsWanted) {
  const SteeringMove move = MoveSteering(Limits(), 0.2, 0.2);
  EXPECT_EQ(move.ramp_time, 0.0);
  EXPECT_EQ(move.At(0.0), 0.2);
  EXPECT_EQ(move.At(1.0), 0.2);
}

}  // namespace steering_actuator_test
}  // namespace trackbed

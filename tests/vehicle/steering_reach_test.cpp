#include "trackbed/vehicle/steering_reach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {
namespace {

// Rounding: some ten operations on numbers of order one.
constexpr double kReachRounding = 1e-14;

/// The reference car with wheels that turn to 0.3 rad to the left and 0.4 rad to the right.
VehicleParams LopsidedCar() {
  VehicleParams car = ReferenceCar();
  car.steering_response.curve = {{-0.5, -0.4}, {-0.2, -0.2}, {0.2, 0.2}, {0.5, 0.3}};
  car.steering_response.backlash = 0.02;
  return car;
}

TEST(SteeringReach, IsTheLimitWithoutACurve) {
  VehicleParams car = ReferenceCar();
  car.steering_response.backlash = 0.02;  // larger commands compensate it
  for (const double side : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(SteeringReach(car, side), car.steering_limit);
  }
}

TEST(SteeringReach, EndsAtTheCurveMinusHalfOfTheBacklash) {
  VehicleParams car = LopsidedCar();
  EXPECT_NEAR(SteeringReach(car, 1.0), 0.29, Tolerance(kReachRounding));
  EXPECT_NEAR(SteeringReach(car, -1.0), 0.39, Tolerance(kReachRounding));
  EXPECT_NEAR(SteeringReach(car, 0.0), 0.29, Tolerance(kReachRounding));
  car.steering_limit = 0.35;
  EXPECT_NEAR(SteeringReach(car, -1.0), 0.35, Tolerance(kReachRounding));
}

TEST(SteeringReach, IsWhereTheActuatorStops) {
  // Commands beyond the curve's ends, held for a thousand periods without lag.
  const VehicleParams car = LopsidedCar();
  for (const double side : {-1.0, 1.0}) {
    SteeringFilter filter(car.steering_response, 0.01, 0.0);
    double angle = 0.0;
    for (int i = 0; i < 1000; ++i) {
      angle = filter.Pass(2.0 * side);
    }
    EXPECT_NEAR(side * angle, SteeringReach(car, side), Tolerance(kReachRounding));
  }
}

TEST(SteeringReach, BoundsTheTurningRadius) {
  // Planners turn to both sides, so the weaker side counts: r = L/tan(0.29).
  const VehicleParams car = LopsidedCar();
  EXPECT_NEAR(car.min_turning_radius(), car.wheelbase / std::tan(0.29),
              Tolerance(kReachRounding * 10.0));
}

TEST(SteeringReach, IgnoresACurveToOneSide) {
  // The wheels are 0.02 rad left of straight ahead where they turn farthest to the right.
  VehicleParams car = LopsidedCar();
  for (Vec2& point : car.steering_response.curve) {
    point.y() += 0.42;
  }
  for (const double side : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(SteeringReach(car, side), car.steering_limit);
  }
}

}  // namespace
}  // namespace trackbed

#include "trackbed/vehicle/steady_turn.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"

// Tests the steering of steady turns: the closed form of a car with an understeer gradient, the
// force balance of the axles, and rates from differences of angles.
namespace trackbed {
namespace steady_turn_test {

/// Returns the reference car with linear tyres.
VehicleParams LinearCar() {
  VehicleParams car = ReferenceCar();
  car.yaw_inertia = 2000.0;
  car.cornering_stiffness_front = 80e3;
  car.cornering_stiffness_rear = 115e3;
  return car;
}

/// Returns the car on tyres with a friction coefficient of 0.9.
VehicleParams BrushCar() {
  VehicleParams car = LinearCar();
  const double front = car.cg_to_rear / car.wheelbase;
  car.friction_lateral = 0.9;
  car.braking.axles = {{.weight = front, .force = 0.7, .transfer = 0.2},
                       {.weight = 1.0 - front, .force = 0.3, .transfer = -0.2}};
  car.driving.axles = {{.weight = front, .force = 1.0, .transfer = -0.2},
                       {.weight = 1.0 - front, .force = 0.0, .transfer = 0.2}};
  return car;
}

/// Returns the lateral force of an axle with the slip angle `slip` by the brush model (Pacejka
/// 2012, ch. 3) [N].
double BrushForce(double stiffness, double friction_force, double slip) {
  const double q = stiffness * slip / (3.0 * friction_force);
  return stiffness * slip * (1.0 - q + q * q / 3.0);
}

TEST(SteadyTurn, OfACarWithoutTyresIsGeometric) {
  const VehicleParams car = ReferenceCar();
  const BendMotion bend{.curvature = 0.04, .sharpness = 0.01, .speed = 12.0, .acceleration = -4.0};
  EXPECT_NEAR(SteeringInBend(car, bend), std::atan(2.7 * 0.04), Tolerance(1e-15));
  // d delta/dt = v L kappa'/(1 + (L kappa)^2)
  EXPECT_NEAR(SteeringRateInBend(car, bend), 12.0 * 2.7 * 0.01 / (1.0 + std::pow(2.7 * 0.04, 2)),
              Tolerance(1e-15));
}

TEST(SteadyTurn, OfALinearCarHasItsUndersteerGradient) {
  const VehicleParams car = LinearCar();
  // K = m/L (l_r/C_f - l_f/C_r)
  const double gradient = 1317.0 / 2.7 * (1.4 / 80e3 - 1.3 / 115e3);
  for (const double speed : {5.0, 20.0, -8.0}) {
    SCOPED_TRACE(speed);
    const BendMotion bend{
        .curvature = 0.01, .sharpness = 0.002, .speed = speed, .acceleration = 3.0};
    const double factor = 2.7 + gradient * speed * std::abs(speed);
    EXPECT_NEAR(SteeringInBend(car, bend), std::atan(0.01 * factor), Tolerance(1e-15));
    // tan(delta) = kappa (L + K u |u|), with d kappa/dt = |u| kappa' and d|u|/dt = a
    const double rate = (std::abs(speed) * 0.002 * factor + 0.01 * 2.0 * gradient * speed * 3.0) /
                        (1.0 + std::pow(0.01 * factor, 2));
    EXPECT_NEAR(SteeringRateInBend(car, bend), rate, Tolerance(1e-14));
  }
}

TEST(SteadyTurn, OfBrushTyresBalancesTheForces) {
  // At the slip angles of the turn, the brush model gives each axle its fraction of m v^2 kappa.
  // The tolerance allows for rounding of forces of up to 6 kN.
  const VehicleParams car = BrushCar();
  const double front = 1.4 / 2.7;
  for (const double road : {1.0, 0.4}) {
    for (const double lateral : {1.0, 2.5, 3.2}) {
      SCOPED_TRACE(fmt::format("road {}, {} m/s^2", road, lateral));
      const double speed = 15.0;
      const SteadyTurn turn =
          BrushTurnOn(car, {.curvature = lateral / 225.0, .speed = speed, .road = road}).turn;
      const double rear_slip = turn.heading_error;
      const double front_slip = std::tan(turn.steering) - 2.7 * lateral / 225.0 + rear_slip;
      const double grip = 0.9 * road * 1317.0 * kGravity;
      EXPECT_NEAR(BrushForce(80e3, grip * front, front_slip), 1317.0 * lateral * front,
                  Tolerance(1e-8));
      EXPECT_NEAR(BrushForce(115e3, grip * (1.0 - front), rear_slip),
                  1317.0 * lateral * (1.0 - front), Tolerance(1e-8));
    }
  }
}

TEST(SteadyTurn, SteersFasterWithTyresNearTheirLimit) {
  const VehicleParams car = BrushCar();
  const auto rate = [&](double road) {
    return SteeringRateInBend(car,
                              {.curvature = 0.02, .sharpness = 0.005, .speed = 12.0, .road = road});
  };
  const double geometric = 12.0 * 2.7 * 0.005 / (1.0 + std::pow(2.7 * 0.02, 2));
  EXPECT_GT(rate(1.0), 1.1 * geometric);  // 2.9 of 8.8 m/s^2
  EXPECT_GT(rate(0.4), 1.1 * rate(1.0));  // 2.9 of 3.5 m/s^2
}

TEST(SteadyTurn, HasTheRateOfItsAngle) {
  // Central differences over 2 x 1e-4 s have a relative error of about (1e-4 s/T)^2 = 1e-6, because
  // the motion changes over a time T above 0.1 s. The tolerance also covers rounding errors of
  // 1e-16/1e-4.
  const VehicleParams car = BrushCar();
  std::mt19937 random(52);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int i = 0; i < 200; ++i) {
    const double direction = i % 4 == 0 ? -1.0 : 1.0;
    const double speed = uniform(4.0, 20.0);
    const double road = uniform(0.5, 1.0);
    const double lateral = uniform(-0.8, 0.8) * 0.9 * road * kGravity;
    const BendMotion now{.curvature = lateral / (speed * speed),
                         .sharpness = uniform(-0.01, 0.01),
                         .speed = direction * speed,
                         .acceleration = uniform(-5.0, 5.0),
                         .road = road};
    const auto after = [&](double time) {
      BendMotion later = now;
      later.curvature += now.sharpness * speed * time;
      later.speed = direction * (speed + now.acceleration * time);
      return SteeringInBend(car, later);
    };
    constexpr double kStep = 1e-4;  // [s]
    const double expected = (after(kStep) - after(-kStep)) / (2.0 * kStep);
    EXPECT_NEAR(SteeringRateInBend(car, now), expected, Tolerance(1e-6 + 1e-5 * std::abs(expected)))
        << i;
  }
}

}  // namespace steady_turn_test
}  // namespace trackbed

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/sim/car_grip.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant.h"

// Tests the model f1tenth against the parameters of f1tenth_gym, which are repeated here.
namespace trackbed {
namespace f1tenth_test {

constexpr double kMass = 3.74;             // m [kg]
constexpr double kYawInertia = 0.04712;    // I [kg m^2]
constexpr double kFront = 0.15875;         // lf [m]
constexpr double kRear = 0.17145;          // lr [m]
constexpr double kHeight = 0.074;          // h [m]
constexpr double kFriction = 1.0489;       // mu
constexpr double kStiffnessFront = 4.718;  // C_Sf [1/rad]
constexpr double kStiffnessRear = 5.4562;  // C_Sr [1/rad]
constexpr double kAcceleration = 9.51;     // a_max [m/s^2]
constexpr double kSwitchingSpeed = 7.319;  // v_switch [m/s]
constexpr double kGravity = 9.81;

const CarModel& F1tenth() {
  static const CarModel car(ComposeScene(FindModel("f1tenth", ""), {}), "f1tenth");
  return car;
}

TEST(F1tenth, HasTheParametersOfTheGym) {
  const VehicleParams& params = F1tenth().params();
  EXPECT_EQ(params.name, "f1tenth");
  // Masses, positions and inertias in the file have 16 digits, and are summed over ten bodies.
  const double rounding = Tolerance(1e-12);
  EXPECT_NEAR(params.mass, kMass, rounding);
  EXPECT_NEAR(params.yaw_inertia, kYawInertia, rounding);
  EXPECT_NEAR(params.cg_to_rear, kRear, rounding);
  EXPECT_NEAR(params.cg_to_front(), kFront, rounding);
  EXPECT_NEAR(F1tenth().chassis().cg_height, kHeight, rounding);
  EXPECT_EQ(params.steering_limit, 0.4189);
  EXPECT_EQ(params.steering_rate, 3.2);
  EXPECT_NEAR(params.length, 0.58, rounding);
  EXPECT_NEAR(params.width, 0.31, rounding);
  // The gym's rectangle is about the center of gravity.
  EXPECT_NEAR(params.rear_overhang, 0.29 - kRear, rounding);
}

TEST(F1tenth, TyresHaveTheStiffnessesOfTheGym) {
  const VehicleParams& params = F1tenth().params();
  // The axle forces of f1tenth_gym are mu C_S F_z alpha, with the static loads F_z of a
  // single-track model. The file rounds the stiffnesses to nine digits.
  const double load = kMass * kGravity / (kFront + kRear);
  const double front = kFriction * kStiffnessFront * load * kRear;
  const double rear = kFriction * kStiffnessRear * load * kFront;
  EXPECT_NEAR(params.cornering_stiffness_front, front, Tolerance(1e-8) * front);
  EXPECT_NEAR(params.cornering_stiffness_rear, rear, Tolerance(1e-8) * rear);
  EXPECT_NEAR(params.friction_lateral, kFriction, Tolerance(1e-9));
  EXPECT_NEAR(params.friction_longitudinal, kFriction, Tolerance(1e-9));
}

TEST(F1tenth, ReachesTheAccelerationsOfTheGym) {
  const VehicleParams& params = F1tenth().params();
  // The file gives the torques with four digits: 1.904 N m and 0.247 N m. The tolerance is half a
  // unit of the last digit.
  EXPECT_NEAR(params.max_acceleration, kAcceleration, Tolerance(5e-4) * kAcceleration);
  EXPECT_NEAR(params.max_deceleration, kAcceleration, Tolerance(5e-4) * kAcceleration);
  // Above v_switch, the acceleration is a_max v_switch/v. The power is given with four digits.
  const GgvDiagram diagram = ComputeGgv(F1tenth(), TyreLaw::kAuto, {1.0});
  for (const double speed : {8.0, 10.0, 15.0}) {
    const double expected = kAcceleration * kSwitchingSpeed / speed;
    EXPECT_NEAR(diagram.AccelerationsAt({.speed = speed}).largest, expected,
                Tolerance(5e-3) * expected);
  }
}

TEST(F1tenth, StandsStillAtRest) {
  const World world;
  const auto plant = MakePlant("mujoco", {.car = F1tenth(), .world = world, .start = {}});
  const auto before = plant->Configuration();
  while (plant->Observe().time < 1.0) {
    plant->Step({});
  }
  // In the configuration qpos0, the springs carry the sprung mass. The deflection of the tyres
  // differs by less than 1 um.
  EXPECT_NEAR(plant->Configuration()[2], before[2], Tolerance(1e-5));
  EXPECT_NEAR(plant->Observe().pitch, 0.0, Tolerance(1e-5));
}

}  // namespace f1tenth_test
}  // namespace trackbed

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <tuple>

#include "tests/sim/cars.h"
#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/sim/plant.h"

// Tests straight runs with centered wheels, and the steering linkage of the front wheels.
namespace trackbed {
namespace {

CarModel Car(const std::string& name, double timestep = 0.002) {
  return {ComposeScene(FindModel(name, ""), {.timestep = timestep}), name};
}

struct Run {
  double speed;     // [m/s]
  double yaw;       // [rad]
  double timestep;  // [s]
};

void PrintTo(const Run& run, std::ostream* out) {
  *out << fmt::format("{} m/s with heading {} rad, timestep {} s", run.speed, run.yaw,
                      run.timestep);
}

class Straight : public testing::TestWithParam<std::tuple<const char*, const char*, Run>> {};

INSTANTIATE_TEST_SUITE_P(
    Runs, Straight,
    testing::Combine(testing::Values("prius", "bmw320i"),
                     testing::Values("mujoco:magic_formula", "mujoco:contact"),
                     testing::Values(Run{3.0, 0.7, 0.002}, Run{20.0, 0.0, 0.002},
                                     Run{20.0, 0.7, 0.001}, Run{20.0, 0.7, 0.004},
                                     Run{30.0, 0.7, 0.002})),
    kNamedByParameter);

TEST_P(Straight, RunsDoNotLeaveTheirLine) {
  const auto& [name, plant_name, run] = GetParam();
  const auto& [speed, yaw, timestep] = run;
  const CarModel car = Car(name, timestep);
  const World world;
  const auto plant = MakePlant(
      plant_name, {.car = car, .world = world, .start = {.pose = {0.0, 0.0, yaw}, .speed = speed}});
  const auto steps = std::lround(60.0 / timestep);
  double aside = 0.0;
  for (long i = 0; i < steps; ++i) {
    plant->Step({.acceleration = i % 10 == 0 ? speed - plant->Observe().speed : 0.0});
    const Pose2 pose = plant->pose();
    aside = std::max(aside, std::abs(ToLocal({0.0, 0.0, yaw}, pose.position()).y()));
  }
  ASSERT_FALSE(plant->diverged());
  EXPECT_GT(plant->Observe().distance, 59.0 * speed);
  // Left and right are mirror images. The remaining error is rounding, 1e-16 of 1800 m at each of
  // 60 000 steps, and the resulting heading error times the distance.
  EXPECT_LE(aside, Tolerance(1e-6));
}

class Linkage : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

INSTANTIATE_TEST_SUITE_P(Cars, Linkage,
                         testing::Combine(testing::Values("prius", "bmw320i"),
                                          testing::Values("mujoco:magic_formula",
                                                          "mujoco:contact")),
                         kNamedByParameter);

TEST_P(Linkage, PointsBothWheelsAtOneCenter) {
  const auto& [name, plant_name] = GetParam();
  const CarModel car = Car(name);
  const VehicleParams& params = car.params();
  const World world;
  const auto plant = MakePlant(plant_name, {.car = car, .world = world, .start = {.speed = 2.0}});
  const std::vector<std::string> columns = car.configuration_columns();
  const auto column = [&](const char* joint) {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), joint) -
                                    columns.begin());
  };
  // Steers from lock to lock and back to the center, at the actuator's rate.
  const double sweep = params.steering_limit / params.steering_rate;
  double largest = 0.0;
  for (double t = 0.0; t < 4.0 * sweep; t += 0.002) {
    const double wanted = t < sweep ? 2.0 : t < 3.0 * sweep ? -2.0 : 0.0;
    plant->Step({.steering = wanted, .acceleration = 2.0 - plant->Observe().speed});
    const std::vector<double> at = plant->Configuration();
    const FrontAngles exact = AckermannAngles(params, at[column("rack_rad")]);
    ASSERT_EQ(at[column("steer_fl_rad")], exact.left) << t;
    ASSERT_EQ(at[column("steer_fr_rad")], exact.right) << t;
    largest = std::max(largest, std::abs(at[column("rack_rad")]));
  }
  EXPECT_NEAR(largest, params.steering_limit, Tolerance(0.005));
}

TEST(Linkage, SharesTheLateralForceBetweenTheFrontTyres) {
  // A turn at 3 m/s with a radius of 15 m needs m v^2/r = 800 N in total. The test detects front
  // tyres that push against each other.
  const CarModel car = Car("prius");
  const World world;
  const double steering = SteeringForCurvature(car.params(), 1.0 / 15.0);
  const auto plant =
      MakePlant("mujoco:contact",
                {.car = car, .world = world, .start = {.speed = 3.0, .steering = steering}});
  double difference = 0.0;  // mean over the last second [N]
  for (int i = 0; i < 2000; ++i) {
    plant->Step({.steering = steering, .acceleration = 3.0 - plant->Observe().speed});
    if (i >= 1500) {
      const auto wheels = *plant->Observe().wheels;
      difference += (wheels[0].lateral_force - wheels[1].lateral_force) / 500.0;
    }
  }
  // Together, the front tyres carry about 400 N. The turn transfers 10 % of the load to the outer
  // tyre, which therefore carries about 40 N more. The bound of 120 N is three times this
  // difference.
  EXPECT_LE(std::abs(difference), Tolerance(120.0));
}

TEST(AckermannSlopes, AreTheAnglesDerivatives) {
  const VehicleParams params = Car("prius").params();
  constexpr double kStep = 1e-5;
  for (double steering = -0.48; steering < 0.485; steering += 0.06) {
    const FrontAngles slope = AckermannSlopes(params, steering);
    const FrontAngles low = AckermannAngles(params, steering - kStep);
    const FrontAngles high = AckermannAngles(params, steering + kStep);
    // The error of a central difference is h^2 f'''/6 with f''' of at most 10, plus rounding of
    // 1e-16/h.
    EXPECT_NEAR(slope.left, 0.5 * (high.left - low.left) / kStep, Tolerance(2e-9));
    EXPECT_NEAR(slope.right, 0.5 * (high.right - low.right) / kStep, Tolerance(2e-9));
  }
}

class Coasting : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

INSTANTIATE_TEST_SUITE_P(Cars, Coasting,
                         testing::Combine(testing::Values("prius", "bmw320i"),
                                          testing::Values("mujoco:magic_formula",
                                                          "mujoco:contact")),
                         kNamedByParameter);

/// Resistances of a coasting car that runs straight.
struct Resistance {
  double mass = 0.0;     // With the inertia of the wheels [kg].
  double rolling = 0.0;  // [N]
  double drag = 0.0;     // Drag divided by the squared speed [N s^2/m^2].
};

Resistance ResistanceOf(const CarModel& car, const std::string& plant_name) {
  const VehicleParams& params = car.params();
  const CarParts& parts = car.parts();
  Resistance result{.mass = params.mass, .drag = 0.5 * kAirDensity * parts.aerodynamics.drag_area};
  for (std::size_t w = 0; w < 4; ++w) {
    result.mass += parts.spin_inertia[w] / std::pow(params.wheel_radius, 2);
    result.rolling += car.get()->dof_frictionloss[parts.spin_dof[w]] / params.wheel_radius;
    if (plant_name == "mujoco:magic_formula") {
      const double arm = w < 2 ? params.cg_to_rear : params.cg_to_front();
      result.rolling += parts.tyres->axle[w / 2].rolling_resistance * 0.5 * params.mass * kGravity *
                        arm / params.wheelbase;
    }
  }
  return result;
}

TEST_P(Coasting, LosesSpeedToDragAndRollingResistance) {
  const auto& [name, plant_name] = GetParam();
  const CarModel car = Car(name);
  const World world;
  constexpr double kSpeed = 25.0;  // [m/s]
  constexpr double kTime = 10.0;   // [s]
  const auto plant =
      MakePlant(plant_name, {.car = car, .world = world, .start = {.speed = kSpeed}});
  for (int i = 0; i < 5000; ++i) {
    plant->Step({.coast = true});
  }
  // With the rolling resistance F and the drag c v^2, the coasting car obeys m v' = -F - c v^2. The
  // solution is v = sqrt(F/c) tan(atan(v_0 sqrt(c/F)) - t sqrt(F c)/m).
  const Resistance of = ResistanceOf(car, plant_name);
  const double scale = std::sqrt(of.rolling / of.drag);
  const double expected = scale * std::tan(std::atan(kSpeed / scale) -
                                           kTime * std::sqrt(of.rolling * of.drag) / of.mass);
  const double lost = kSpeed - expected;
  EXPECT_GT(lost, 0.3);
  // The tolerance of 2 % of the speed loss covers the first half second, in which the tyres reach
  // their slip and the body settles on its springs.
  EXPECT_NEAR(plant->Observe().speed, expected, Tolerance(0.02 * lost));
}

// The brakes of a coasting car are released, so the car rolls back down the slope on which it
// stood: m v' = -m g sin(slope) + F.
TEST_P(Coasting, RollsBackDownASlopeFromRest) {
  const auto& [name, plant_name] = GetParam();
  constexpr double kSlope = 0.06;
  World world;
  world.ground.grade = {kSlope, 0.0};
  const CarModel car = CarWith(name, {}, 0.002, world);
  const auto plant = MakePlant(plant_name, {.car = car, .world = world, .start = {}});
  const int steps = static_cast<int>(std::lround(5.0 / car.timestep()));
  for (int i = 0; i < steps; ++i) {
    plant->Step({.coast = true});
  }
  const Resistance of = ResistanceOf(car, plant_name);
  const double pull = car.params().mass * kGravity * std::sin(std::atan(kSlope));
  const double expected = -(pull - of.rolling) / of.mass * steps * car.timestep();
  // The drag at the end is 0.4 % of the pull. The tolerance of 2 % also covers the first half
  // second, in which the body settles on its springs.
  EXPECT_NEAR(plant->Observe().speed, expected, Tolerance(0.02 * std::abs(expected)));
}

TEST(Acceleration, IsThatOfTheCenterOfGravityAtItsHeight) {
  const CarModel car = Car("bmw320i");
  const World world;
  const auto plant =
      MakePlant("mujoco:magic_formula", {.car = car, .world = world, .start = {.speed = 20.0}});
  const auto center = [&] {
    const std::vector<double> at = plant->Configuration();
    const Eigen::Quaterniond turn(at[3], at[4], at[5], at[6]);
    return Eigen::Vector3d(
        Eigen::Vector3d(at[0], at[1], at[2]) +
        turn.normalized() * Eigen::Vector3d(car.params().cg_to_rear, 0.0, car.parts().cg_height));
  };
  constexpr double kStep = 0.002;
  Eigen::Vector3d before = center();
  Eigen::Vector3d now = before;
  double largest = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Pose2 pose = plant->pose();
    plant->Step({.steering = 0.05});
    const Eigen::Vector3d next = center();
    const VehicleState state = plant->Observe();
    if (i > 50) {
      const Vec2 acceleration = (next - 2.0 * now + before).head<2>() / (kStep * kStep);
      const double lateral = LeftNormal(Direction(pose.yaw)).dot(acceleration);
      largest = std::max(largest, std::abs(lateral));
      // The logged acceleration belongs to the previous step, and a second difference to its
      // middle. During the step, the body turns at up to 0.5 rad/s for 2 ms, which changes 8 m/s^2
      // by a fraction of 1e-3. The change of the acceleration within a step is as large.
      EXPECT_NEAR(state.lateral_acceleration, lateral, Tolerance(0.03)) << i;
    }
    before = now;
    now = next;
  }
  EXPECT_GT(largest, 3.0);
}

}  // namespace
}  // namespace trackbed

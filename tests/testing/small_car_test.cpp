#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/tolerance.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/testing/scenario_testing.h"

/// Tests a car of a tenth of the size of the Prius, for which only the MJCF file differs.
namespace trackbed {
namespace {

std::filesystem::path Data(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests" / "data" / name;
}

/// Scales a scenario of the full-size car to a tenth: divides lengths by 10 and sets the speed to
/// 0.8 m/s.
Scenario Scaled(const std::string& name) {
  Scenario scenario =
      ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml"));
  scenario.vehicle.model = Data("models/small_car.xml").string();
  scenario.mission.speed = 0.8;
  for (Vec2& point : scenario.mission.waypoints) {
    point /= 10.0;
  }
  scenario.control.steering = PreviewOptions{.distance = 0.25};
  scenario.expect = {};
  return scenario;
}

// A chord with the length of the preview distance R = 0.25 m runs up to R^2/(8 r) = 4.6 mm inside
// an arc of radius r >= 1.7 m. At the beginning and the end of an arc, the car deviates from the
// path by up to this distance. kParting bounds the additional deviation by the dynamics.
constexpr double kParting = 0.002;               // [m]
constexpr double kTracking = 0.0046 + kParting;  // [m]

// The servo lags by 10 ms, which is 8 mm of road, so the heading is up to 8 mm/r = 4 mrad behind.
// The slip speed of the contacts, a_y dmax tau/2 = 0.33 m/s^2 * 5 ms/2, divided by the speed of 0.8
// m/s, adds 1 mrad. The controller removes both errors within the preview distance. This leaves 5
// mrad * 0.25 m = 1.3 mm, which is rounded up to kParting.

TEST(SmallCar, IsReadFromItsOwnFile) {
  const Scenario scenario = ReadScenario(Data("small_three_turns.yaml"));
  const CarModel car = LoadCar(scenario);
  const VehicleParams& params = car.params();
  EXPECT_EQ(params.name, "small_car");
  const double rounding = Tolerance(1e-12);
  EXPECT_NEAR(params.wheelbase, 0.26, rounding);
  EXPECT_NEAR(params.track_front, 0.17, rounding);
  EXPECT_NEAR(params.mass, 3.0, rounding);
  EXPECT_NEAR(params.cg_to_rear, 0.125, rounding);
  EXPECT_NEAR(car.parts().cg_height, 0.04, rounding);
  EXPECT_EQ(params.steering_limit, 0.42);
  EXPECT_EQ(params.steering_rate, 0.6);
}

TEST(SmallCar, StandsStill) {
  Scenario scenario = ReadScenario(Data("small_three_turns.yaml"));
  scenario.plan.reset();
  scenario.control.steering = ConstantSteeringOptions{};
  scenario.mission.start.speed = 0.0;
  scenario.mission.speed = 1.0;
  scenario.control.speed.braking = Braking{.at = 0.0, .deceleration = 1.0};  // on its brakes
  scenario.mission.duration = 2.0;
  scenario.drive.plants = {"mujoco"};
  const RunResult run = RunScenario(scenario);
  ASSERT_EQ(run.logs.size(), 1U);
  // The heights of the hubs are accurate to 10 um, which is 4e-5 rad of pitch over the wheelbase.
  // The car has settled in all other respects.
  const LogRow& last = run.logs[0].rows.back();
  EXPECT_NEAR(last.state.pose.x, 0.0, Tolerance(1e-5));
  EXPECT_NEAR(last.state.pose.y, 0.0, Tolerance(1e-5));
  EXPECT_NEAR(last.state.pitch, 0.0, Tolerance(1e-4));
  EXPECT_NEAR(last.state.roll, 0.0, Tolerance(1e-6));
  double load = 0.0;
  for (const WheelState& wheel : *last.state.wheels) {
    load += wheel.normal_force;
  }
  EXPECT_NEAR(load, 3.0 * 9.81, Tolerance(1e-6 * 3.0 * 9.81));
}

TEST(SmallCar, DrivesThreeTurnsAndStops) {
  const RunResult run = RunScenario(Data("small_three_turns.yaml"));
  EXPECT_THAT(run, TracksWithin(Tolerance(kTracking)));
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco", Tolerance(kParting)));
  // The run ends at a speed below 1 cm/s. With the speed control's gain of 2 1/s, the remaining
  // position error is at most 5 mm.
  EXPECT_THAT(run, ReachesGoal(Tolerance(0.005)));
}

class ScaledScenarios : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(SmallCar, ScaledScenarios,
                         testing::Values("three_turns", "winding", "slalom"),
                         [](const auto& name) { return std::string(name.param); });

TEST_P(ScaledScenarios, AreDrivenByTheSmallCar) {
  const RunResult run = RunScenario(Scaled(GetParam()));
  EXPECT_THAT(run, TracksWithin(Tolerance(kTracking)));
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco", Tolerance(kParting)));
  EXPECT_THAT(run, ReachesGoal(Tolerance(0.005)));
}

}  // namespace
}  // namespace trackbed

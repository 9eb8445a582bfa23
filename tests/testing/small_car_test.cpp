#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/tolerance.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/testing/scenario_testing.h"

/// A car of a tenth of the first one's size: only its MJCF file differs.
namespace trackbed {
namespace {

std::filesystem::path Data(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests" / "data" / name;
}

/// A scenario of the full-size car scaled to a tenth: lengths divided by 10, at 0.8 m/s.
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

// On an arc of radius r, a preview chord of length R runs up to R^2/(8 r) inside the path; entering
// and leaving the arc adds as much. The turns have r >= 1.7 m, and R = 0.25 m: 4.6 mm. kParting
// bounds the effect of the dynamics.
constexpr double kParting = 0.002;               // [m]
constexpr double kTracking = 0.0046 + kParting;  // [m]

// The servo lags by 10 ms, 8 mm of road, so the heading is up to 8 mm/r = 4 mrad behind. The
// contact slip, a_y dmax tau/2 = 0.33 x 5 ms/2 over 0.8 m/s, adds 1 mrad. The controller removes
// both within the preview distance: 5 mrad x 0.25 m = 1.3 mm, rounded up to kParting.

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
  // The hubs' heights are accurate to 10 um, which is 4e-5 rad of pitch over the wheelbase; nothing
  // else settles.
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
  // It stops at a speed below 1 cm/s, so the speed controller's remaining correction (gain 2/s) is
  // at most 5 mm.
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

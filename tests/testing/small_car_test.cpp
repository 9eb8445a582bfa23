#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/tolerance.h"
#include "trackbed/testing/scenario_testing.h"

/// A second car, a tenth of the first one's size: nothing but its own MJCF makes it drive.
namespace trackbed {
namespace {

std::filesystem::path Data(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests" / "data" / name;
}

/// A scenario of the full-size car at a tenth of its size: lengths by 10, at 0.8 m/s.
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

// Cutting a corner: with the point at distance R ahead on a curve of radius r, the car runs up to
// R^2/(8 r) inside it (the sagitta of the preview chord). The steering room makes the radius of a
// right-angled turn 1.8 m or more, so R = 0.25 m gives 4.3 mm; the contacts' slip adds less than
// that again.
constexpr double kTracking = 0.009;  // [m]

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
  scenario.mission.speed = 1e-6;  // slower than what counts as standing
  scenario.mission.duration = 2.0;
  scenario.drive.plants = {"mujoco"};
  const RunResult run = RunScenario(scenario);
  ASSERT_EQ(run.logs.size(), 1U);
  // The springs are preloaded to four digits of their 14 mm of travel: it settles by micrometres,
  // not by its travel.
  const LogRow& last = run.logs[0].rows.back();
  EXPECT_NEAR(last.state.pose.x, 0.0, Tolerance(1e-5));
  EXPECT_NEAR(last.state.pose.y, 0.0, Tolerance(1e-5));
  EXPECT_NEAR(last.state.pitch, 0.0, Tolerance(1e-3));
  EXPECT_NEAR(last.state.roll, 0.0, Tolerance(1e-6));
  double load = 0.0;
  for (const WheelState& wheel : *last.state.wheels) {
    load += wheel.normal_force;
  }
  EXPECT_NEAR(load, 3.0 * 9.81, Tolerance(0.01 * 3.0 * 9.81));
}

TEST(SmallCar, DrivesThreeTurnsAndStops) {
  const RunResult run = RunScenario(Data("small_three_turns.yaml"));
  EXPECT_THAT(run, TracksWithin(Tolerance(kTracking)));
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco", Tolerance(0.002)));
  // It stops when it is slower than 1 cm/s, and the speed controller's last correction (gain 2/s)
  // stands for 5 mm at most.
  EXPECT_THAT(run, ReachesGoal(Tolerance(0.005)));
}

class ScaledScenarios : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(SmallCar, ScaledScenarios,
                         testing::Values("three_turns", "winding", "slalom"),
                         [](const auto& name) { return std::string(name.param); });

TEST_P(ScaledScenarios, AreDrivenByTheSmallCar) {
  const RunResult run = RunScenario(Scaled(GetParam()));
  EXPECT_THAT(run, TracksWithin(Tolerance(kTracking)));
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco", Tolerance(0.01)));
  EXPECT_THAT(run, ReachesGoal(Tolerance(0.005)));
}

}  // namespace
}  // namespace trackbed

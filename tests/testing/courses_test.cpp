// Tests controllers at speeds with tyre slip, in whole runs on Magic Formula tyres.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <tuple>

#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/lqr.h"
#include "trackbed/control/mpc.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/preview_integral.h"
#include "trackbed/control/pure_pursuit.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace {

std::filesystem::path Course(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "courses" / (name + ".yaml");
}

/// A course of scenarios/courses with curvatures scaled for a lateral acceleration of 0.4 g at
/// `speed`.
Scenario CourseAt(const std::string& name, const std::string& car, double speed) {
  Scenario scenario = ReadScenario(Course(name));
  const double share = (scenario.mission.speed * scenario.mission.speed) / (speed * speed);
  for (CoursePiece& piece : scenario.plan->global.Get<CourseOptions>().segments) {
    for (std::optional<double>* curvature : {&piece.curvature, &piece.curvature_to}) {
      if (*curvature) {
        **curvature *= share;
      }
    }
  }
  scenario.mission.speed = speed;
  scenario.vehicle.model = car;
  scenario.expect = {};
  return scenario;
}

class Courses : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Files, Courses, testing::Values("s_course", "step_course"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Courses, MeetTheirExpectations) {
  const Scenario scenario = ReadScenario(Course(GetParam()));
  EXPECT_EQ(scenario.name, GetParam());
  EXPECT_THAT(RunScenario(scenario), MeetsItsExpectations());
}

using Drive = std::tuple<std::string, double, std::string>;

class SCourse : public testing::TestWithParam<Drive> {};

INSTANTIATE_TEST_SUITE_P(Cars, SCourse,
                         testing::Combine(testing::Values("prius", "bmw320i"),
                                          testing::Values(15.0, 20.0),
                                          testing::Values("lqr", "mpc", "preview")),
                         [](const auto& test) {
                           return fmt::format("{}_{}_{:.0f}", std::get<0>(test.param),
                                              std::get<2>(test.param), std::get<1>(test.param));
                         });

TEST_P(SCourse, IsDrivenWithin30Centimeters) {
  // The course has two opposed arcs with a lateral acceleration of 0.4 g, joined by ramps of 15 m.
  // The bound is the lateral room in a lane; docs/algorithms/control.md lists the measured values.
  const auto& [car, speed, controller] = GetParam();
  Scenario scenario = CourseAt("s_course", car, speed);
  if (controller == "lqr") {
    scenario.control.steering = LqrOptions{};
  } else if (controller == "mpc") {
    scenario.control.steering = MpcOptions{};
  } else {
    scenario.control.steering = PreviewOptions{.time = 0.6, .slip = true};
  }
  const RunResult run = RunScenario(scenario);
  EXPECT_THAT(run, TracksWithin(Tolerance(0.3)));
}

TEST(SCourse, PreviewIsLeftOutsideWithoutItsSlip) {
  // The Prius understeers: the circle through the preview point takes more steering than without
  // slip.
  Scenario scenario = CourseAt("s_course", "prius", 20.0);
  const auto largest = [&](bool slip) {
    scenario.control.steering = PreviewOptions{.distance = 8.0, .slip = slip};
    return RunScenario(scenario).metrics.at(0).tracking->cross_track_max;
  };
  EXPECT_LT(largest(true), 0.6 * largest(false));
}

TEST(SCourse, PreviewTracksWithShortAndLongDistances) {
  // At 20 m/s, a preview distance of 4 m is 0.2 s. When the law measured the direction of motion of
  // the rear axle, which lags by as much, the car weaved by 0.74 m. The bound is that of the
  // course.
  Scenario scenario = CourseAt("s_course", "prius", 20.0);
  for (const PreviewOptions& options :
       {PreviewOptions{.distance = 4.0}, PreviewOptions{.distance = 8.0}, PreviewOptions{}}) {
    scenario.control.steering = options;
    EXPECT_THAT(RunScenario(scenario), TracksWithin(Tolerance(0.3)))
        << options.distance.value_or(0.0);
  }
}

TEST(SlowDrives, FollowersTrackInSpiteOfTheirSteering) {
  // The disturbances are a delayed actuator, backlash, a wrong steering factor, and a kick. The
  // kinematic car isolates the controller.
  for (const char* disturbance : {"disturb.steering.delay=0.1", "disturb.steering.backlash=0.00873",
                                  "disturb.steering.factor=0.9", "disturb.steering.factor=1.1",
                                  "disturb.kicks=[{at: 5, displacement: 0.5}]"}) {
    for (const char* method :
         {"preview", "preview_integral", "optimal_steering", "pure_pursuit", "lqr", "mpc"}) {
      SCOPED_TRACE(fmt::format("{} with {}", method, disturbance));
      // In bends, optimal_steering dithers between neighboring optima, by less than 0.3 degrees.
      const RunResult run = RunScenario(
          std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "winding.yaml",
          {fmt::format("control={{method: {}}}", method), disturbance, "drive.plants=[kinematic]",
           fmt::format("expect={{reach_goal: 0.5, metrics: [{{metric: "
                       "oscillation.amplitude, max: {}}}]}}",
                       std::string(method) == "optimal_steering" ? 0.005 : 0.0)});
      EXPECT_THAT(run, MeetsItsExpectations());
      EXPECT_LE(run.metrics.front().tracking->cross_track_rms, 0.10);
    }
  }
}

TEST(SlowDrives, FollowersTrackThreeTurnsAndWinding) {
  // MuJoCo's car drives at 3 m/s on arcs that begin with a curvature step.
  for (const char* name : {"three_turns", "winding"}) {
    for (const ControllerOptions& options :
         {ControllerOptions(LqrOptions{}), ControllerOptions(MpcOptions{}),
          ControllerOptions(PreviewIntegralOptions{}), ControllerOptions(PurePursuitOptions{})}) {
      SCOPED_TRACE(fmt::format("{} by {}", name, ControllerFor(options).name));
      Scenario scenario = ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" /
                                       (std::string(name) + ".yaml"));
      scenario.control.steering = options;
      scenario.drive.plants = {"mujoco"};
      scenario.expect = {};
      EXPECT_THAT(RunScenario(scenario), TracksWithin(Tolerance(0.2)));
    }
  }
}

}  // namespace
}  // namespace trackbed

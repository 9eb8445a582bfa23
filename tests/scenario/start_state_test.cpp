// Tests the start state of a run, which planners, plants and checks share.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/support/temp_folder.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace {

// The path's heading and the car's come from one function, so they agree to the last bit.
TEST(StartState, IsWherePathsAlongTheRouteBegin) {
  Random random(3);
  FilletOptions options;
  options.radius = 6.0;
  options.constraint = RadiusConstraint::kNone;
  int planned = 0;
  for (int i = 0; i < 500; ++i) {
    Scenario scenario;
    for (int k = 0; k < 3; ++k) {
      scenario.mission.waypoints.emplace_back(random.Uniform(-90.0, 90.0),
                                              random.Uniform(-90.0, 90.0));
    }
    SCOPED_TRACE(fmt::format("route {}", i));
    const Pose2 start = InitialState(scenario).pose;
    const FilletPlan fillets =
        PlanFillets(ReferenceCar(), scenario.mission.waypoints, 3.0, options);
    const RoundedCorners rounded =
        RoundCorners(ReferenceCar(), scenario.mission.waypoints, {}, {ReferenceCar(), {}, 0.0});
    if (fillets.status == PlanStatus::kOk) {
      ++planned;
      EXPECT_EQ(fillets.path.At(0.0).pose, start);
    }
    if (rounded.status == PlanStatus::kOk) {
      EXPECT_EQ(rounded.path.At(0.0).pose, start);
    }
  }
  EXPECT_GT(planned, 100);
}

// A course begins with the curvature of its first segment, and the car's wheels with the angle of
// this curvature, unless the mission fixes the angle or the car cannot steer it.
TEST(StartState, HasTheSteeringOfTheCourse) {
  const auto steering = [](const std::string& first, const std::string& mission) {
    const Scenario scenario =
        ParseScenario("schema: 1\nname: x\nmission: {speed: 3" + mission +
                          "}\nplan: {method: course, segments: [{length: 20, " + first + "}]}\n",
                      "x.yaml", {});
    return InitialState(scenario, ReferenceCar()).steering;
  };
  EXPECT_EQ(steering("curvature: -0.05", ""), std::atan(2.7 * -0.05));
  EXPECT_EQ(steering("curvature: -0.05", ", start: {speed: 0}"), std::atan(2.7 * -0.05));
  EXPECT_EQ(steering("curvature_from: 0.08, curvature_to: 0", ""), std::atan(2.7 * 0.08));
  EXPECT_EQ(steering("curvature_to: 0.1", ""), 0.0);
  EXPECT_EQ(steering("curvature: 0.05", ", start: {steering: 0.01}"), 0.01);
  EXPECT_EQ(steering("curvature: 5", ""), 0.0);
}

// The mission's speed may be missing exactly if the start defines a speed.
TEST(StartState, HasTheSpeedThatReplacesTheMissions) {
  const TempFolder folder;
  folder.Write("r.csv", "t_s,steering_rad,speed_mps\n0,0,5\n9,0,5\n");
  struct Case {
    const char* keys;
    std::optional<double> speed;  ///< none: rejected
  };
  for (const auto& [keys, speed] : {
           Case{"control: {method: sine, amplitude: 0.01}\nmission: {duration: 3}", std::nullopt},
           Case{"control: {method: sine, amplitude: 0.01}\n"
                "mission: {duration: 3, start: {speed: 0}}",
                0.0},
           Case{"control: {method: sine, amplitude: 0.01, speed: {over_time: [[0, 4], [2, 6]]}}\n"
                "mission: {duration: 3}",
                4.0},
           Case{"control: {method: playback, file: r.csv}\nmission: {}", 5.0},
           Case{"control: {method: playback, file: r.csv}\nmission: {start: {speed: 2}}", 2.0},
       }) {
    SCOPED_TRACE(keys);
    const std::string yaml = std::string("schema: 1\nname: x\n") + keys + "\n";
    if (speed) {
      EXPECT_EQ(InitialState(ParseScenario(yaml, "x.yaml", folder.path())).speed, *speed);
    } else {
      EXPECT_THROW(ParseScenario(yaml, "x.yaml", folder.path()), InputError);
    }
  }
}

}  // namespace
}  // namespace trackbed

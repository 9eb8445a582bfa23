#include "src/scenario/check_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/error_text.h"
#include "trackbed/control/playback.h"
#include "trackbed/control/preview.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/scenario/scenario.h"

// Tests that a scenario that a program fills in code is checked as strictly as a file.
namespace trackbed {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns a scenario without problems.
Scenario InCode() {
  Scenario scenario;
  scenario.name = "corner";
  scenario.vehicle.model = "prius";
  scenario.mission.speed = 3.0;
  scenario.mission.waypoints = {{0.0, 0.0}, {30.0, 0.0}, {30.0, 30.0}};
  scenario.plan = PlanSpec{.global = FilletOptions{}};
  scenario.control.steering = PreviewOptions{.distance = 2.5};
  return scenario;
}

struct WrongValue {
  const char* name;
  std::function<void(Scenario&)> set;
  const char* message;
};

class ScenarioInCode : public ::testing::TestWithParam<WrongValue> {};

TEST_P(ScenarioInCode, IsRefusedWithTheKey) {
  Scenario scenario = InCode();
  EXPECT_NO_THROW(CheckScenario(scenario));
  GetParam().set(scenario);
  EXPECT_EQ(ErrorText([&] { CheckScenario(scenario); }), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Values, ScenarioInCode,
    ::testing::Values(
        WrongValue{"not_a_number", [](Scenario& s) { s.mission.waypoints[1].x() = kNan; },
                   "mission.waypoints[1][0]: expected a finite number, found nan"},
        WrongValue{"option_of_a_method",
                   [](Scenario& s) { s.control.steering = PreviewOptions{.distance = -1.0}; },
                   "control.distance: -1 is out of range; must be at least 0.01 and at most 1000"},
        WrongValue{"optional_number", [](Scenario& s) { s.mission.start.speed = -1.0; },
                   "mission.start.speed: -1 is out of range; must be at least 0 and at most 100"},
        WrongValue{"list_of_numbers",
                   [](Scenario& s) {
                     s.mission.headings = {0.0, 0.0, kNan};
                   },
                   "mission.headings[2]: expected a finite number, found nan"},
        WrongValue{"unknown_name", [](Scenario& s) { s.drive.plants = {"kinematik"}; },
                   "drive.plants[0]: unknown 'kinematik'; did you mean 'kinematic'?"},
        WrongValue{"unknown_camera", [](Scenario& s) { s.render.camera = "chas"; },
                   "render.camera: unknown 'chas'; did you mean 'chase'?"},
        WrongValue{"name_twice",
                   [](Scenario& s) {
                     s.drive.plants = {"mujoco", "mujoco"};
                   },
                   "drive.plants[1]: 'mujoco' is listed twice"},
        WrongValue{"name_of_the_folder", [](Scenario& s) { s.name = "../corner"; },
                   "name: '../corner' is not a valid folder name; must be up to 100 letters, "
                   "digits, '_', '-' and '.', not starting with '.'"},
        WrongValue{"no_name", [](Scenario& s) { s.name = ""; }, "name: missing"},
        WrongValue{"no_enumerator",
                   [](Scenario& s) { s.drive.steering = static_cast<SteeringInput>(77); },
                   "drive.steering: unknown value; allowed: actuator, prescribed"},
        WrongValue{"negative_speed", [](Scenario& s) { s.mission.speed = -3.0; },
                   "mission.speed: -3 is out of range; must be at least 0.1 and at most 100"},
        WrongValue{"speed_not_a_number", [](Scenario& s) { s.mission.speed = kNan; },
                   "mission.speed: expected a finite number, found nan"},
        WrongValue{"empty_optional_text", [](Scenario& s) { s.vehicle.tyre_file = ""; },
                   "vehicle.tyre_file: expected a name, found an empty text"},
        WrongValue{"fraction_in_origin", [](Scenario& s) { s.origin = Vec2(0.5, 0.0); },
                   "origin: must be two whole numbers [x, y], such as [500000, 5200000]"},
        WrongValue{"plant_of_expectations_twice",
                   [](Scenario& s) {
                     s.expect.plants = {{"mujoco", {}}, {"mujoco", {}}};
                   },
                   "expect.mujoco: 'mujoco' is listed twice"},
        WrongValue{"map_without_file", [](Scenario& s) { s.world.map = MapSpec{}; },
                   "world.map.file: missing"},
        WrongValue{"map_that_was_not_read",
                   [](Scenario& s) { s.world.map = MapSpec{.file = "map.yaml"}; },
                   "world.map.file: map.yaml has not been read; ReadScenario and ParseScenario "
                   "read it"},
        WrongValue{
            "record_that_was_not_read",
            [](Scenario& s) { s.record = RecordSpec{.file = "log.csv", .ground = "road.csv"}; },
            "record.file: log.csv has not been read; ReadScenario and ParseScenario read it\n"
            "record.ground: road.csv has not been read; ReadScenario and ParseScenario read "
            "it"},
        WrongValue{"playback_without_recording",
                   [](Scenario& s) { s.control.steering = PlaybackOptions{}; },
                   "control.file: missing; name a file and use ReadScenario or ParseScenario, "
                   "which read it, or set PlaybackOptions::recording"},
        WrongValue{"recording_that_was_not_read",
                   [](Scenario& s) { s.control.steering = PlaybackOptions{.file = "turns.csv"}; },
                   "control.file: turns.csv has not been read; ReadScenario and ParseScenario "
                   "read it"},
        WrongValue{"recording_out_of_order",
                   [](Scenario& s) {
                     PlaybackOptions playback;
                     playback.recording.steering.knots = {{0.0, 0.1}, {2.0, 0.2}, {1.0, 0.0}};
                     playback.recording.speed.knots = {{0.0, 3.0}, {1.0, kNan}};
                     s.control.steering = std::move(playback);
                   },
                   "control.file: the recorded steering is not finite, or its times do not "
                   "increase\n"
                   "control.file: the recorded speed is not finite, or its times do not increase"},
        WrongValue{"recording_of_speed_and_acceleration",
                   [](Scenario& s) {
                     PlaybackOptions playback{.by = PlaybackAxis::kDistance};
                     playback.recording.steering.knots = {{0.0, 0.1}};
                     playback.recording.speed.knots = {{0.0, 3.0}};
                     playback.recording.acceleration.knots = {{0.0, 0.0}};
                     s.control.steering = std::move(playback);
                   },
                   "control.file: the recording has both speed and acceleration; remove one"},
        WrongValue{"track_that_was_not_read",
                   [](Scenario& s) { s.mission.track = TrackSpec{.file = "oval.csv"}; },
                   "mission.track.file: oval.csv has not been read; ReadScenario and ParseScenario "
                   "read it"},
        WrongValue{
            "roads_that_were_not_read",
            [](Scenario& s) { s.world.road_network = RoadNetworkSpec{"town.xodr"}; },
            "world.road_network: town.xodr has not been read; ReadScenario and ParseScenario "
            "read it"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ScenarioInCodeValues, AreListedTogether) {
  Scenario scenario = InCode();
  scenario.drive.timestep = 1.0;
  scenario.drive.plants = {"kinematik"};
  scenario.render.fps = 0.0;
  std::vector<std::string> keys;
  for (const auto& [key, message] : ValueProblems(scenario)) {
    keys.push_back(key);
  }
  EXPECT_THAT(keys, ::testing::ElementsAre("drive.plants[0]", "drive.timestep", "render.fps"));
}

// A program may give the content of a file without the file's name.
TEST(ScenarioInCodeValues, MayHaveTheContentOfAFileOnly) {
  Scenario scenario = InCode();
  const GridMap free{.X_WM = {}, .columns = 1, .rows = 1, .cells = {MapCell::kFree}};
  scenario.world.map =
      MapSpec{.file = "", .data = std::make_shared<const MapObstacles>(free, UnknownCells::kFree)};
  EXPECT_THAT(ValueProblems(scenario), ::testing::IsEmpty());
}

// ValueProblems checks by the same declarations as the reader, so it accepts what the reader does.
TEST(ScenarioInCodeValues, OfEveryScenarioFileHaveNoProblem) {
  for (const auto& file : std::filesystem::directory_iterator(TRACKBED_SOURCE_DIR "/scenarios")) {
    if (file.path().extension() == ".yaml") {
      EXPECT_THAT(ValueProblems(ReadScenario(file.path())), ::testing::IsEmpty()) << file.path();
    }
  }
}

}  // namespace
}  // namespace trackbed

#include "trackbed/scenario/record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace record_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

const fs::path kSource = TRACKBED_SOURCE_DIR;

constexpr const char* kMap = R"(schema: 1
name: bus
time: {column: t}
position: {x: x, y: y}
yaw: {column: yaw, unit: deg}
steering_command: {column: c, unit: 1, curve: [[-1, -0.4], [1, 0.4]]}
)";

/// Removes the folder from an error message.
std::string Without(const TempFolder& folder, std::string text) {
  const std::string prefix = folder.path().string() + "/";
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
    text.erase(at, prefix.size());
  }
  return text;
}

std::string MapProblems(const std::string& yaml) {
  const TempFolder folder;
  try {
    ReadLogMap(folder.Write("map.yaml", yaml));
  } catch (const InputError& error) {
    return Without(folder, error.what());
  }
  return "no problem";
}

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

TEST(ReadLogMap, TakesItsKeys) {
  const TempFolder folder;
  const LogMap map = ReadLogMap(folder.Write("map.yaml", kMap));
  EXPECT_EQ(map.time.column, "t");
  EXPECT_EQ(map.yaw->unit, "deg");
  EXPECT_EQ(map.steering_command->unit, "1");
  EXPECT_THAT(map.steering_command->curve, ElementsAre(Vec2(-1.0, -0.4), Vec2(1.0, 0.4)));
  EXPECT_FALSE(map.speed);
}

TEST(ReadLogMap, IsStrict) {
  EXPECT_EQ(MapProblems(kMap), "no problem");
  EXPECT_EQ(MapProblems(Replaced(kMap, "column: yaw", "colum: yaw")),
            "map.yaml:5:6: yaw.column: missing\n"
            "map.yaml:5:7: yaw.colum: unknown key 'colum'; did you mean 'column'?");
  EXPECT_EQ(MapProblems(Replaced(kMap, "unit: deg", "unit: degree")),
            "map.yaml:5:26: yaw.unit: unknown 'degree'; allowed: rad, deg");
  EXPECT_EQ(MapProblems(Replaced(kMap, ", unit: deg", "")), "map.yaml:5:6: yaw.unit: missing");
  EXPECT_EQ(MapProblems(Replaced(kMap, "[1, 0.4]]", "[-1, 0.4]]")),
            "map.yaml:6:60: steering_command.curve[1]: -1 must be above the previous -1");
  EXPECT_EQ(MapProblems(std::string(kMap) + "orientation: {x: a, y: b, z: c, w: d}\n"),
            "map.yaml:5:6: yaw: give either yaw or orientation");
  EXPECT_EQ(MapProblems(std::string(kMap) + "valid: [{column: ok}]\n"),
            "map.yaml:7:9: valid[0]: give equals, min or max");
  EXPECT_EQ(MapProblems(std::string(kMap) + "from: 3\nto: 2\n"),
            "map.yaml:8:5: to: 2 s is not above from, 3 s");
}

TEST(ReadLogMap, ReadsTheShippedMaps) {
  for (const char* name : {"autoware", "dart", "f1tenth", "trackbed"}) {
    const fs::path file = kSource / "scenarios/real/maps" / (std::string(name) + ".yaml");
    EXPECT_EQ(ReadLogMap(file).name, name);
    EXPECT_TRUE(IsLogMap(file));
  }
  EXPECT_FALSE(IsLogMap(kSource / "scenarios/three_turns.yaml"));
  EXPECT_FALSE(IsLogMap(kSource / "scenarios/none.yaml"));
}

/// A log of 5 s at 1 m/s on a circle to the left with a radius of 5 m. It starts at x = 2 m, y = 1
/// m with a heading of 90 degrees. Angles are in degrees and commands in the units of kMap.
std::string Log() {
  std::string csv = "t,x,y,yaw,c\n";
  for (int i = 0; i <= 250; ++i) {
    const double t = 100.0 + 0.02 * i;
    const double turned = 0.2 * 0.02 * i;
    csv += fmt::format("{},{},{},{},{}\n", t, -3.0 + 5.0 * std::cos(turned),
                       1.0 + 5.0 * std::sin(turned), 90.0 + turned * 180.0 / M_PI, 0.5);
  }
  return csv;
}

constexpr const char* kScenario = R"(schema: 1
name: replay
mission: {}
record: {file: log.csv, map: map.yaml}
control: {method: playback}
drive: {plants: [recorded, kinematic]}
)";

class RecordScenarios : public testing::Test {
 protected:
  RecordScenarios() {
    folder_.Write("log.csv", Log());
    folder_.Write("map.yaml", kMap);
  }

  [[nodiscard]] Scenario Read(const std::vector<Override>& overrides = {}) const {
    return ParseScenario(kScenario, "replay.yaml", folder_.path(), overrides);
  }

  [[nodiscard]] std::string Problems(const std::vector<Override>& overrides) const {
    try {
      static_cast<void>(Read(overrides));
    } catch (const InputError& error) {
      return Without(folder_, error.what());
    }
    return "no problem";
  }

  TempFolder folder_;
};

TEST_F(RecordScenarios, StartWhereTheRecordStarts) {
  const Scenario scenario = Read();
  const StartState start = InitialState(scenario);
  // Parabolas that are fitted over 0.1 s deviate from the circle by R (0.1 s * 0.2 1/s)^3 / 2 =
  // 2e-5 m. The error of a speed is 2/(0.1 s) times this distance, 4e-4 m/s.
  EXPECT_NEAR(start.pose.x, 2.0, Tolerance(2e-5));
  EXPECT_NEAR(start.pose.y, 1.0, Tolerance(2e-5));
  EXPECT_NEAR(start.pose.yaw, 0.5 * M_PI, Tolerance(1e-9));
  EXPECT_NEAR(start.speed, 1.0, Tolerance(4e-4));
  EXPECT_NEAR(*start.yaw_rate, 0.2, Tolerance(1e-7));
  EXPECT_NEAR(*start.lateral_speed, 0.0, Tolerance(4e-4));
  EXPECT_NEAR(start.steering, 0.2, Tolerance(1e-12));  // halfway along the command's curve
  EXPECT_NEAR(*RunDuration(scenario), 5.0, Tolerance(1e-9));
  const Recording& inputs = *FindRecording(scenario);
  EXPECT_NEAR(inputs.steering.At(2.0), 0.2, Tolerance(1e-12));
  EXPECT_NEAR(inputs.speed.At(2.0), 1.0, Tolerance(4e-4));
  EXPECT_TRUE(inputs.acceleration.empty());
}

TEST_F(RecordScenarios, StartElsewhereIfAsked) {
  const StartState start = InitialState(Read({"mission.start={x: 7, speed: 3, steering: 0.1}"}));
  EXPECT_EQ(start.pose.x, 7.0);
  EXPECT_NEAR(start.pose.y, 1.0, Tolerance(2e-5));
  EXPECT_EQ(start.speed, 3.0);
  EXPECT_EQ(start.steering, 0.1);
  EXPECT_FALSE(start.yaw_rate);
}

TEST_F(RecordScenarios, CutAPartOut) {
  const Scenario scenario = Read({"record.from=1", "record.to=3"});
  EXPECT_NEAR(*RunDuration(scenario), 2.0, Tolerance(1e-9));
  EXPECT_NEAR(InitialState(scenario).pose.yaw, 0.5 * M_PI + 0.2, Tolerance(1e-9));
}

TEST_F(RecordScenarios, ResolveToTheSameRecord) {
  const Scenario scenario = Read({"record.from=1", "record.windows=[1, 2]"});
  const TempFolder& elsewhere = folder_;
  elsewhere.Write("run/record.csv", RecordCsv(*scenario.record->data));
  const Scenario again =
      ParseScenario(ResolvedYaml(scenario), "resolved.yaml", elsewhere.path() / "run");
  ASSERT_TRUE(again.record->data);
  EXPECT_EQ(RecordCsv(*again.record->data), RecordCsv(*scenario.record->data));
  EXPECT_THAT(again.record->windows, ElementsAre(1.0, 2.0));
  EXPECT_EQ(again.record->data->notes, scenario.record->data->notes);
  EXPECT_EQ(ResolvedYaml(again), ResolvedYaml(scenario));
  EXPECT_EQ(InitialState(again).steering, InitialState(scenario).steering);
  EXPECT_EQ(*InitialState(again).yaw_rate, *InitialState(scenario).yaw_rate);
  EXPECT_EQ(FindRecording(again)->steering.knots, FindRecording(scenario)->steering.knots);
}

TEST_F(RecordScenarios, SayWhatIsWrong) {
  EXPECT_EQ(Problems({"record.file=lag.csv"}),
            "--set: record.file: cannot read lag.csv: No such file or directory");
  EXPECT_EQ(Problems({"record.map=mop.yaml"}),
            "--set: record.map: cannot read mop.yaml: No such file or directory");
  EXPECT_THAT(Problems({"record.file=../log.csv"}),
              HasSubstr("--set: record.file: ../log.csv lies outside of the folder"));
  EXPECT_EQ(Problems({"record.steering=measured"}),
            "--set: record.steering: the recording 'log' has no measured steering angle; of "
            "steering, steering_command and throttle its map names: steering_command");
  EXPECT_EQ(Problems({"record.drive=throttle"}),
            "--set: record.drive: the recording 'log' has no throttle; of steering, "
            "steering_command and throttle its map names: steering_command");
  EXPECT_EQ(Problems({"record.windows=[1, 6]"}),
            "--set: record.windows[1]: 6 s is longer than the record, 5 s");
  EXPECT_EQ(Problems({"record.windows=[1, 1]"}), "--set: record.windows[1]: 1 s is listed twice");
  EXPECT_EQ(Problems({"control.by=distance"}),
            "--set: control.by: a record is replayed over time; remove this");
  EXPECT_THAT(Problems({"plan={method: fillet}", "mission.speed=2",
                        "mission.waypoints=[[0, 0], [9, 0], [9, 9]]"}),
              HasSubstr("record: not allowed with a plan; remove one"));
  folder_.Write("log.csv", "t,x,y,yaw,c\n0,0,0,0,0\n1,0,zero,0,0\n");
  EXPECT_EQ(Problems({}), "log.csv:3: cell 3 (y): 'zero' is not a number");
}

TEST_F(RecordScenarios, NeedARecordForTheRecordedPlant) {
  try {
    ParseScenario(
        "schema: 1\nname: a\nmission: {speed: 1, duration: 1}\ncontrol: {method: "
        "constant_steering, steering: 0}\n"
        "drive: {plants: [recorded]}\n",
        "a.yaml", folder_.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("drive.plants: recorded needs a record"));
  }
}

TEST(DrivenPlantNames, HaveTheRecordLast) {
  EXPECT_EQ(DrivenPlantNames().back(), "recorded");
  EXPECT_EQ(DrivenPlantNames().size(), 6U);
}

}  // namespace record_test
}  // namespace trackbed

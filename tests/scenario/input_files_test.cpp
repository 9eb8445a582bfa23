#include "trackbed/scenario/input_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/control/playback.h"
#include "trackbed/scenario/record_scenario.h"

namespace trackbed {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

using Files = std::vector<std::pair<std::string, std::string>>;

/// Names and sources of the input files.
Files Listed(const Scenario& scenario) {
  Files files;
  for (const InputFile& file : InputFiles(scenario)) {
    files.emplace_back(file.name, file.source);
  }
  return files;
}

/// Writes the input files of a scenario to an inner folder and reads the scenario again.
Scenario ReadBack(const TempFolder& folder, const Scenario& scenario) {
  folder.Write("run/x", "");  // makes the folder
  for (const InputFile& file : InputFiles(scenario)) {
    folder.Write("run/" + file.name, file.content);
  }
  return ParseScenario(ResolvedYaml(scenario), "resolved.yaml", folder.path() / "run");
}

constexpr const char* kMission = "schema: 1\nname: x\nmission: {speed: 4}\n";

TEST(InputFiles, AreNoneWithoutNamedFiles) {
  const TempFolder folder;
  const Scenario scenario = ParseScenario(std::string(kMission) + "plan: {method: straight}\n",
                                          "test.yaml", folder.path());
  EXPECT_THAT(Listed(scenario), IsEmpty());
  EXPECT_EQ(ResolvedYaml(ReadBack(folder, scenario)), ResolvedYaml(scenario));
}

TEST(InputFiles, AreThoseOfThePlanner) {
  const TempFolder folder;
  folder.Write("lane.csv", "x_m,y_m\n0,0\n5,0\n10,0.2\n");
  for (const char* plan :
       {"{method: path_file, file: lane.csv}",
        "{global: {method: path_file, file: lane.csv}, replan: {along: {method: frenet}}}"}) {
    const Scenario scenario =
        ParseScenario(std::string(kMission) + "plan: " + plan + "\n", "test.yaml", folder.path());
    EXPECT_THAT(Listed(scenario), ElementsAre(Pair("path.csv", "path lane.csv")));
    EXPECT_EQ(ResolvedYaml(ReadBack(folder, scenario)), ResolvedYaml(scenario));
    EXPECT_EQ(InputFiles(ReadBack(folder, scenario))[0].content, InputFiles(scenario)[0].content);
  }
}

// Films and reports read the lanes from the run folder, and so does a run of the resolved scenario.
TEST(InputFiles, ContainTheLanesBesideThePath) {
  const TempFolder folder;
  folder.Write("lane.csv", "x_m,y_m\n0,0\n5,0\n10,0.2\n");
  folder.Write("map.csv", "lane,left_x_m,left_y_m,right_x_m,right_y_m\n0,0,2,0,-2\n0,10,2,10,-2\n");
  const Scenario scenario = ParseScenario(
      std::string(kMission) + "plan: {method: path_file, file: lane.csv, lanes: map.csv}\n",
      "test.yaml", folder.path());
  EXPECT_THAT(Listed(scenario),
              ElementsAre(Pair("path.csv", "path lane.csv"), Pair("lanes.csv", "lanes map.csv")));
  EXPECT_EQ(ResolvedYaml(ReadBack(folder, scenario)), ResolvedYaml(scenario));
  EXPECT_EQ(InputFiles(ReadBack(folder, scenario))[1].content, InputFiles(scenario)[1].content);
}

TEST(InputFiles, AreThoseOfTheController) {
  const TempFolder folder;
  folder.Write("steps.csv", "time,steering_rad\n0,0\n1,0.1\n");
  const Scenario scenario =
      ParseScenario(std::string(kMission) +
                        "control: {method: playback, file: steps.csv, columns: {time: time}}\n",
                    "test.yaml", folder.path());
  EXPECT_THAT(Listed(scenario), ElementsAre(Pair("recording.csv", "recording steps.csv")));
  EXPECT_EQ(ResolvedYaml(ReadBack(folder, scenario)), ResolvedYaml(scenario));
}

TEST(InputFiles, OfAReplayedRecordAreTheRecordAlone) {
  RecordedDrive drive;
  drive.name = "x";
  drive.period = 0.1;
  drive.samples = {{.time = 0.0}, {.time = 0.1}, {.time = 0.2}};
  drive.has_steering = true;
  Scenario scenario = RecordScenario(std::make_shared<const RecordedDrive>(drive), "prius");
  EXPECT_THAT(Listed(scenario), ElementsAre(Pair("record.csv", "record record.csv")));
  // A recording of a file is kept beside the record.
  scenario.control.steering.Get<PlaybackOptions>().file = "steps.csv";
  EXPECT_THAT(Listed(scenario), ElementsAre(Pair("record.csv", "record record.csv"),
                                            Pair("recording.csv", "recording steps.csv")));
}

TEST(InputFileNames, AreThoseOfAllMethods) {
  EXPECT_THAT(InputFileNames(), testing::IsSupersetOf({"record.csv", "track.csv", "map.yaml",
                                                       "map.pgm", "road_network.xodr",
                                                       "recording.csv", "path.csv", "lanes.csv"}));
}

}  // namespace
}  // namespace trackbed

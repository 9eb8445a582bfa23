#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A study of the kinematic car on the winding route.
std::string StudyText(const std::string& keys) {
  return "schema: 1\nname: study\nscenario: " + ScenarioFile("winding") + "\n" + keys;
}

constexpr const char* kDistances =
    "set: {drive.plants: [kinematic]}\n"
    "vary: {control.distance: [1, 2.5, 10]}\n"
    "outputs: [metrics.kinematic.cross_track.max]\n";

TEST(Sweep, WritesATableAndWhereItComesFrom) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kDistances));
  const Outcome outcome = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  // A preview of ten meters cuts the corners; a failed run is a result, not an error.
  EXPECT_THAT(outcome.output, StartsWith("study: 3 rows from 3 runs, 2 passed, in "
                                         "out/study/sweep.csv\n"));
  // The output also shows a table of the rows.
  EXPECT_THAT(outcome.output, testing::ContainsRegex("\n +2\\.5 +passed +0\\.0[0-9]+\n"));
  const std::string csv = ReadFile(folder.path() / "out/study/sweep.csv");
  EXPECT_THAT(csv, testing::MatchesRegex(
                       "control\\.distance,status,metrics\\.kinematic\\.cross_track\\.max,reason\n"
                       "1,passed,0\\.[0-9]+,\n2\\.5,passed,0\\.[0-9]+,\n"
                       "10,failed,[0-9.]+,\"kinematic: maximum cross-track error .*\"\n"));
  EXPECT_THAT(ReadFile(folder.path() / "out/study/sweep.json"), HasSubstr("\"complete\": true"));
  EXPECT_EQ(Trackbed(folder, "sweep study.yaml -q -o again --jobs 4").output, "");
  for (const char* name : {"sweep.csv", "sweep.json"}) {
    EXPECT_EQ(ReadFile(folder.path() / "again" / name),
              ReadFile(folder.path() / "out/study" / name));
  }
}

TEST(Sweep, WritesTheSameBytesForAnyNumberOfJobs) {
  const TempFolder folder;
  // Rows with one plant or both and three speeds differ in duration, so that later rows finish
  // before earlier ones.
  folder.Write("study.yaml", StudyText("set: {drive.time_limit: 4, expect: {}}\n"
                                       "vary:\n"
                                       "  drive.plants: [[kinematic, mujoco], [kinematic]]\n"
                                       "  mission.speed: {from: 1, to: 3, steps: 3}\n"
                                       "outputs: [metrics.kinematic.distance, "
                                       "metrics.mujoco.distance]\n"));
  for (const char* jobs : {"1", "2", "5", "100"}) {
    const std::string out = std::string("jobs") + jobs;
    ASSERT_EQ(Trackbed(folder, "sweep study.yaml -q -o " + out + " --jobs " + jobs).code, 0);
    for (const char* name : {"sweep.csv", "sweep.json"}) {
      EXPECT_EQ(ReadFile(folder.path() / out / name), ReadFile(folder.path() / "jobs1" / name))
          << name << " of " << jobs << " jobs";
    }
  }
}

TEST(Sweep, LeavesCellsEmptyThatARunHasNoValueFor) {
  const TempFolder folder;
  // At the turn of 56 degrees, half of the shorter leg is 18.03 m. A turn by 56 degrees with the
  // radius R needs the length R tan(28 deg) of each leg, so a radius of 40 m does not fit. The
  // second point has no plant mujoco.
  folder.Write("study.yaml",
               StudyText("set: {drive.time_limit: 1, expect: {}}\n"
                         "list:\n"
                         "  - {drive.plants: [mujoco], mission.speed: 2, plan.radius: "
                         "20}\n"
                         "  - {drive.plants: [kinematic], plan.radius: 10}\n"
                         "  - {drive.plants: [kinematic, mujoco], mission.speed: 3, "
                         "plan.radius: 40}\n"
                         "outputs: [metrics.kinematic.status, "
                         "metrics.mujoco.status, plan.status]\n"));
  const Outcome outcome = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(outcome.code, 0);  // failed runs are results
  EXPECT_THAT(outcome.output, StartsWith("study: 3 rows from 3 runs, 0 passed, in "
                                         "out/study/sweep.csv\n"));
  EXPECT_THAT(outcome.output,
              HasSubstr("   [kinematic]         -        10    failed  time_limit"));
  EXPECT_EQ(
      ReadFile(folder.path() / "out/study/sweep.csv"),
      "drive.plants,mission.speed,plan.radius,status,metrics.kinematic.status,"
      "metrics.mujoco.status,plan.status,reason\n"
      "[mujoco],2,20,failed,,time_limit,ok,\"mujoco: did not reach the goal: time_limit at "
      "s = 2 m, t = 1 s\"\n"
      "[kinematic],,10,failed,time_limit,,ok,\"kinematic: did not reach the goal: time_limit "
      "at s = 3 m, t = 1 s\"\n"
      "\"[kinematic, mujoco]\",3,40,no_plan,,,turn_too_tight,no plan (turn_too_tight): turn of "
      "56.31 deg at waypoint 2: radius 40 m needs 21.41 m of each leg; half of the shorter leg is "
      "18.03 m; set plan.radius to at most 33.685\n");
}

TEST(Sweep, FindsTheHighestValueThatPasses) {
  const TempFolder folder;
  folder.Write("study.yaml",
               StudyText("set: {drive.plants: [kinematic]}\n"
                         "bisect: {key: control.distance, from: 2, to: 10, tolerance: 0.3}\n"));
  const Outcome outcome = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  const std::string csv = ReadFile(folder.path() / "out/study/sweep.csv");
  // The bisection halves an interval of 8 m five times, until it is at most 0.3 m long. Both ends
  // are evaluated as well, so there are seven runs.
  std::smatch found;
  ASSERT_TRUE(std::regex_match(
      csv, found,
      std::regex("control\\.distance,status,runs,reason\n"
                 "([0-9.]+),found,7,\"?at ([0-9.]+): kinematic: maximum cross-track error .*\n")))
      << csv;
  // The verb `run` agrees: the found value passes, and a value that is higher by one tolerance
  // fails.
  const double highest = std::stod(found[1]);
  EXPECT_EQ(std::stod(found[2]), highest + 0.25);  // a 32nd of 8 m
  const auto run_with = [&](double distance) {
    return Trackbed(folder, "run -q " + ScenarioFile("winding") + " --plant kinematic --set " +
                                "control.distance=" + std::to_string(distance))
        .code;
  };
  EXPECT_EQ(run_with(highest), 0);
  EXPECT_EQ(run_with(highest + 0.3), 3);
}

TEST(Sweep, StopsBeforeDrivingWhereItCannotWrite) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kDistances));
  const Outcome outcome = Trackbed(folder, "sweep study.yaml -o study.yaml/here");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot create the folder study.yaml/here: Not a directory\n");
}

TEST(Sweep, SetsKeysOfTheScenarioFromTheCommandLine) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kDistances));
  const Outcome outcome =
      Trackbed(folder, "sweep study.yaml --set drive.time_limit=1 'expect={reach_goal: 1}'");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, StartsWith("study: 3 rows from 3 runs, 0 passed"));
  EXPECT_THAT(ReadFile(folder.path() / "out/study/sweep.json"),
              HasSubstr("\"drive.time_limit=1\""));
}

TEST(Sweep, TellsOfBadInputBeforeAnythingIsDriven) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText("vary: {control.distanse: [1, 2]}\n"));
  const Outcome misspelt = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_EQ(misspelt.output,
            "study.yaml:4:27: control.distanse: unknown key 'distanse'; did you mean "
            "'distance'?\n");
  EXPECT_EQ(Trackbed(folder, "check study.yaml").output, misspelt.output);
  folder.Write("study.yaml", StudyText("repeat: 2\noutputs: [metrics.mujoco.cross_trak.max]\n"));
  const Outcome output = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(output.code, 2);
  EXPECT_EQ(output.output,
            "study.yaml:5:11: outputs[0]: unknown metric 'metrics.mujoco.cross_trak.max'; did you "
            "mean 'metrics.mujoco.cross_track.max'?\n");
  EXPECT_EQ(Trackbed(folder, "sweep none.yaml").output,
            "cannot read none.yaml: No such file or directory\n");
  EXPECT_EQ(Trackbed(folder, "sweep study.yaml --jobs 0").code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST(Sweep, StudiesCanBeCheckedLikeScenarios) {
  const TempFolder folder;
  folder.Write("s/study.yaml", StudyText(kDistances));
  folder.Write("s/scenario.yaml", ReadFile(ScenarioFile("winding")));
  const Outcome outcome = Trackbed(folder, "check s");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output, "s/scenario.yaml: ok\ns/study.yaml: ok\n");
  // The shipped studies are valid, too.
  const Outcome own =
      Trackbed(folder, "check " + std::string(TRACKBED_SOURCE_DIR) + "/scenarios/studies");
  EXPECT_EQ(own.code, 0) << own.output;
}

TEST(Sweep, CtrlCKeepsTheRowsSoFar) {
  const TempFolder folder;
  // The rows take minutes. The output folder appears before the first run; the loop gives up after
  // a minute.
  folder.Write("study.yaml", StudyText("set: {drive.plants: [mujoco]}\n"
                                       "vary: {drive.timestep: [0.00001, 0.00002]}\n"));
  const std::string out = (folder.path() / "r").string();
  const Outcome outcome =
      Trackbed(folder, "sweep study.yaml -j 1 -o " + out + " & n=0; until [ -d " + out +
                           " ] || [ $n -gt 600 ]; do n=$((n + 1)); sleep 0.1; done; kill -INT $!; "
                           "wait $!");
  EXPECT_EQ(outcome.code, 130);
  EXPECT_EQ(outcome.output, "study: interrupted after 0 of 2 rows; the same command goes on, in " +
                                out + "/sweep.csv\n");
  EXPECT_THAT(ReadFile(folder.path() / "r/sweep.json"), HasSubstr("\"complete\": false"));
  EXPECT_EQ(ReadFile(folder.path() / "r/sweep.csv"), "drive.timestep,status,reason\n");
}

/// Six short rows, which fail because they end before the goal; the program rejects the last one.
constexpr const char* kShort =
    "set: {drive.plants: [mujoco], drive.time_limit: 0.1, expect: {}}\n"
    "vary: {control.distance: [1, 2, 3, 4, 5, -1]}\n"
    "outputs: [metrics.mujoco.distance]\n";

void ExpectSameSweep(const TempFolder& folder, const std::string& one, const std::string& other) {
  for (const char* name : {"sweep.csv", "sweep.json", "manifest.json"}) {
    EXPECT_EQ(ReadFile(folder.path() / one / name), ReadFile(folder.path() / other / name))
        << name << " of " << one << " and " << other;
  }
}

TEST(Sweep, ShardsMergeToTheBytesOfOneProcess) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o whole").code, 0);
  for (const int shards : {3, 7}) {  // with seven shards, one shard has no row
    const std::string out = "of" + std::to_string(shards);
    for (int shard = shards; shard >= 1; --shard) {
      const std::string part = std::to_string(shard) + "/" + std::to_string(shards);
      ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o " + out + " --shard " + part).code, 0);
    }
    const Outcome merged = Trackbed(folder, "sweep merge " + out);
    EXPECT_EQ(merged.code, 0);
    EXPECT_EQ(merged.output, "study: 6 of 6 rows from " + std::to_string(shards) +
                                 " files, 0 passed, in " + out +
                                 "/sweep.csv\nstudy: 1 rows without a run: 1 refused, 0 with an "
                                 "internal error; see the column reason\n");
    ExpectSameSweep(folder, "whole", out);
  }
}

TEST(Sweep, TakesItsShardFromSlurmsArray) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  // The array has the tasks 4, 6 and 8.
  const std::string array =
      "SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=4 SLURM_ARRAY_TASK_STEP=2 ";
  for (const char* task : {"4", "6", "8"}) {
    ASSERT_EQ(Shell(folder, array + "SLURM_ARRAY_TASK_ID=" + task +
                                " " TRACKBED_PROGRAM " sweep -q study.yaml -o r")
                  .code,
              0);
  }
  ASSERT_EQ(Trackbed(folder, "sweep merge -q r").code, 0);
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o whole").code, 0);
  ExpectSameSweep(folder, "whole", "r");
  EXPECT_EQ(Shell(folder, array + "SLURM_ARRAY_TASK_ID=3 " TRACKBED_PROGRAM " sweep -q study.yaml")
                .output,
            "SLURM_ARRAY_TASK_ID: 3 is no task of an array of 3 from 4 in steps of 2\n");
}

TEST(Sweep, MergesOnlyWhatIsWholeAndBelongsTogether) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --shard 2/3").code, 0);
  EXPECT_EQ(Trackbed(folder, "sweep merge r").output,
            "r: 4 of 6 rows are missing: 0, 2 to 3, 5; --partial merges what there is\n");
  EXPECT_EQ(Trackbed(folder, "sweep merge -q --partial r").code, 0);
  EXPECT_THAT(ReadFile(folder.path() / "r/sweep.json"), HasSubstr("\"complete\": false"));
  ASSERT_EQ(
      Trackbed(folder, "sweep -q study.yaml -o other --shard 1/3 --set drive.time_limit=0.2").code,
      0);
  EXPECT_THAT(Trackbed(folder, "sweep merge r other").output,
              testing::MatchesRegex("other/shard_1_of_3/sweep.records: is of another study than "
                                    "the first \\(overrides.*\n"));
  // Merging has no --restart.
  const Outcome into = Trackbed(folder, "sweep merge r -o other/shard_1_of_3");
  EXPECT_EQ(into.code, 2);
  EXPECT_THAT(into.output,
              testing::MatchesRegex("other/shard_1_of_3/sweep.records: has rows of another study "
                                    "\\(overrides.*\\); choose another folder for the table "
                                    "\\(-o\\)\n"));
  EXPECT_EQ(Trackbed(folder, "sweep merge empty").output,
            "empty: has neither sweep.records nor folders of shards\n");
  EXPECT_EQ(Trackbed(folder, "sweep study.yaml --shard 4/3").output,
            "--shard: '4/3' is no shard; give I/N, such as 2/7 for the second of seven\n");
}

TEST(Sweep, RefusesToGoOnWithAnotherStudy) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r").code, 0);
  EXPECT_THAT(Trackbed(folder, "sweep study.yaml -o r").output,
              testing::AllOf(StartsWith("study: 6 of 6 rows are there already\n"
                                        "study: 6 rows from 5 runs, 0 passed, in r/sweep.csv\n"),
                             testing::EndsWith("study: 1 rows without a run: 1 refused, 0 with an "
                                               "internal error; see the column reason\n")));
  const std::string other = "sweep -q study.yaml -o r --set drive.time_limit=0.2";
  EXPECT_THAT(Trackbed(folder, other).output,
              testing::MatchesRegex("r/sweep.records: has rows of another study \\(overrides.*"
                                    "--restart removes them.*\n"));
  EXPECT_EQ(Trackbed(folder, other + " --restart").code, 0);
}

TEST(Sweep, RunsARowOnceMoreAsARunOfItsOwn) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r").code, 0);
  ASSERT_EQ(Trackbed(folder, "run -q --from-sweep r --row 3 -o row").code, 3);
  const auto metrics = nlohmann::json::parse(ReadFile(folder.path() / "row/metrics.json"));
  const auto distance = metrics.at("plants").at("mujoco").at("distance").get<double>();
  std::smatch row;
  const std::string csv = ReadFile(folder.path() / "r/sweep.csv");
  ASSERT_TRUE(std::regex_search(csv, row, std::regex("\n4,failed,([0-9.e+-]+),"))) << csv;
  EXPECT_EQ(distance, std::stod(row[1]));  // the same double, written in full
  EXPECT_EQ(Trackbed(folder, "run --from-sweep r --row 6").output,
            "row: 6; the study has 0 to 5\n");
  EXPECT_EQ(Trackbed(folder, "run --from-sweep r").output,
            "give both --from-sweep DIR and --row N, or neither\n");
  EXPECT_EQ(Trackbed(folder, "run --from-sweep r --row 0 " + ScenarioFile("winding")).code, 2);
}

TEST(Sweep, RunsRowsOfAStatusOnceMore) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r").code, 0);
  const auto lines = [&] {
    const std::string text = ReadFile(folder.path() / "r/sweep.records");
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto before = lines();
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --only refused").code, 0);
  EXPECT_EQ(lines(), before + 1);
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --only failed").code, 0);
  EXPECT_EQ(lines(), before + 6);
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --only error").code, 0);
  EXPECT_EQ(lines(), before + 6);
}

TEST(Sweep, SaysThatThereAreNoRowsToRunOnceMore) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kShort));
  const Outcome missing = Trackbed(folder, "sweep study.yaml -o r --only failed");
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(
      missing.output,
      "--only: there are no rows yet in r/sweep.records; leave out --only to run the study\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "r"));
  const Outcome unknown = Trackbed(folder, "sweep study.yaml -o r --only fialed");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("--only: unknown status 'fialed'; did you mean 'failed'?"));
}

std::vector<std::string> NamesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    names.push_back(entry.path().filename());
  }
  return names;
}

TEST(Sweep, KeepsTheRunFoldersThatTheStudyAsksFor) {
  const TempFolder folder;
  // Runs with preview distances of 1 m and 2.5 m pass, and 10 m fails. The error grows with the
  // distance.
  const auto kept = [&](const std::string& keep) {
    folder.Write("study.yaml", StudyText(kDistances + ("keep: " + keep + "\n")));
    const Outcome outcome = Trackbed(folder, "sweep -q study.yaml --restart -o r");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    return NamesIn(folder.path() / "r/rows");
  };
  EXPECT_THAT(kept("none"), testing::IsEmpty());
  EXPECT_THAT(kept("failed"), testing::UnorderedElementsAre("2"));
  EXPECT_THAT(kept("all"), testing::UnorderedElementsAre("0", "1", "2"));
  const std::string row = ReadFile(folder.path() / "r/rows/1/kinematic.csv");
  EXPECT_THAT(kept("worst 2 by metrics.kinematic.cross_track.max"),
              testing::UnorderedElementsAre("1", "2"));
  EXPECT_EQ(ReadFile(folder.path() / "r/rows/1/kinematic.csv"), row);
  EXPECT_THAT(kept("lowest 1 by metrics.kinematic.cross_track.max"),
              testing::UnorderedElementsAre("0"));
  EXPECT_EQ(Trackbed(folder, "report -q r/rows/0").code, 0);
}

TEST(Sweep, RemovesNothingThroughLinks) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kDistances + std::string("keep: all\n")));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o mine").code, 0);
  folder.Write("mine/rows/notes.txt", "mine");
  const std::string row = ReadFile(folder.path() / "mine/rows/1/kinematic.csv");
  const auto refused = [&](const std::string& target, const std::string& link) {
    std::filesystem::remove_all(folder.path() / "r");
    std::filesystem::create_directories((folder.path() / "r" / link).parent_path());
    std::filesystem::create_symlink(folder.path() / target, folder.path() / "r" / link);
    for (const char* how : {"", " --restart", " --shard 1/2"}) {
      if (std::string(link).starts_with("shard") != (std::string(how) == " --shard 1/2")) {
        continue;
      }
      const Outcome outcome = Trackbed(folder, std::string("sweep -q study.yaml -o r") + how);
      EXPECT_EQ(outcome.code, 2) << outcome.output;
      EXPECT_EQ(outcome.output, "cannot write to r/" + link +
                                    ": it is a link, not a folder; remove it, or choose another "
                                    "output folder (-o)\n");
    }
    EXPECT_EQ(ReadFile(folder.path() / "mine/rows/1/kinematic.csv"), row);
    EXPECT_EQ(ReadFile(folder.path() / "mine/rows/notes.txt"), "mine");
    EXPECT_EQ(NamesIn(folder.path() / "mine/rows").size(), 4U);
  };
  refused("mine/rows", "rows");
  refused("mine/rows/1", "rows/1");
  refused("mine/rows/1", "rows/77");
  refused("mine", "shard_1_of_2");
  // The output folder itself is the user's choice.
  std::filesystem::remove_all(folder.path() / "r");
  std::filesystem::create_symlink("mine", folder.path() / "r");
  EXPECT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --restart").code, 0);
}

TEST(Sweep, RestartLeavesTheUsersFilesInKeptRows) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyText(kDistances + std::string("keep: all\n")));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r").code, 0);
  folder.Write("r/rows/0/notes.txt", "mine");
  folder.Write("r/rows/1/deep/plan.csv", "mine");
  folder.Write("r/rows/7/plan.csv", "mine");  // not written by Trackbed
  folder.Write("r/rows/notes.txt", "mine");
  folder.Write("study.yaml", StudyText(kDistances));
  const Outcome foreign = Trackbed(folder, "sweep -q study.yaml -o r --restart");
  EXPECT_EQ(foreign.code, 2);
  EXPECT_EQ(foreign.output,
            "r/rows/7 has files that Trackbed has not written, according to its manifest.json: "
            "plan.csv; move them away, or choose another folder (-o)\n");
  std::filesystem::rename(folder.path() / "r/rows/7", folder.path() / "r/rows/seven");
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml -o r --restart").code, 0);
  std::vector<std::string> left;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(folder.path() / "r/rows")) {
    if (entry.is_regular_file()) {
      left.push_back(entry.path().lexically_relative(folder.path() / "r/rows"));
    }
  }
  EXPECT_THAT(left, testing::UnorderedElementsAre("0/notes.txt", "1/deep/plan.csv",
                                                  "seven/plan.csv", "notes.txt"));
}

TEST(Sweep, StopsWhenThePassRateIsKnown) {
  const TempFolder folder;
  // The study varies speeds around 2.5 m/s, at which a car drives 0.25 m in 0.1 s. Half of the rows
  // pass.
  folder.Write("study.yaml",
               "schema: 1\nname: study\nscenario: " + ScenarioFile("steering_circle") +
                   "\nset: {drive.plants: [kinematic], mission.duration: 0.1, expect: {metrics: "
                   "[{metric: distance, min: 0.25}]}}\n"
                   "sample: {count: 2000, method: random}\n"
                   "vary: {mission.speed: {distribution: uniform, from: 1, to: 4}}\n");
  for (const char* jobs : {"1", "4"}) {
    const Outcome outcome = Trackbed(folder, std::string("sweep study.yaml --until pass_rate:0.05 "
                                                         "-j ") +
                                                 jobs + " -o r" + jobs);
    EXPECT_EQ(outcome.code, 0);
    // The half width of the confidence interval is 0.05 after about (1.96/0.05)^2/4 = 384 rows. The
    // program checks the interval every 100 rows.
    EXPECT_THAT(outcome.output, testing::MatchesRegex("study: stopped after 400 of 2000 rows, "
                                                      "[0-9]+ passed: all pass rates are known to "
                                                      "..0.05 .95 %., in r./sweep.csv\n"));
    EXPECT_THAT(ReadFile(folder.path() / (std::string("r") + jobs) / "sweep.json"),
                HasSubstr("\"stopped\": \"pass_rate:0.05\""));
  }
  ExpectSameSweep(folder, "r1", "r4");
  EXPECT_EQ(
      Trackbed(folder, "sweep study.yaml --until pass_rate:2").output,
      "--until: 'pass_rate:2' is not understood; give pass_rate:W, such as pass_rate:0.01 for "
      "an interval of +-0.01; W from 0.001 to 0.5\n");
  folder.Write("grid.yaml", StudyText(kDistances));
  EXPECT_EQ(Trackbed(folder, "sweep grid.yaml --until pass_rate:0.1").output,
            "--until: needs a study with a sample and without bisect\n");
}

}  // namespace
}  // namespace trackbed

#include "trackbed/analysis/compare_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// A short open-loop run of the plants, without a path.
RunResult Turn(const std::string& plants, const std::string& more = "") {
  return RunScenario(
      ParseScenario("schema: 1\nname: turn\nmission: {duration: 1, speed: 3}\n"
                    "control: {method: constant_steering, steering: 0.1}\ndrive: {plants: [" +
                        plants + "]}\n" + more,
                    "turn.yaml", "."));
}

/// The folder of a finished run along y = `offset`, 10 m long, on each of the plants.
fs::path Line(const TempFolder& folder, const std::string& name, double offset,
              const std::vector<std::pair<std::string, std::string>>& plants) {
  nlohmann::json metrics;
  for (const auto& [plant, status] : plants) {
    metrics["plants"][plant]["status"] = status;
    folder.Write(name + "/" + plant + ".csv",
                 fmt::format("t_s,x_m,y_m,yaw_rad,yaw_rate_radps,steering_rad,s_m\n"
                             "0,0,{0},0,0,0,0\n5,10,{0},0,0,0,10\n",
                             offset));
  }
  folder.Write(name + "/metrics.json", metrics.dump());
  return folder.path() / name;
}

std::vector<std::string> Names(const RunComparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedPair& pair : comparison.pairs) {
    names.push_back(pair.comparison.first + " - " + pair.comparison.second);
  }
  return names;
}

template <typename Call>
std::string ErrorMessage(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(CompareRun, ComparesEveryPairAsTheScenarioExpects) {
  const RunResult run = Turn("kinematic, single_track, mujoco",
                             "expect: {between: [{plants: [single_track, kinematic], "
                             "yaw_rate_max: 1e-6, steering_max: 1}]}\n");
  const RunComparison result = CompareRun(run, {});
  EXPECT_THAT(Names(result), ElementsAre("kinematic - single_track", "kinematic - mujoco",
                                         "single_track - mujoco"));
  EXPECT_EQ(result.pairs[0].bounds.yaw_rate_max, 1e-6);
  EXPECT_FALSE(result.pairs[1].bounds.any());
  EXPECT_FALSE(result.verdict.passed);
  EXPECT_THAT(result.verdict.failures,
              ElementsAre(testing::MatchesRegex(
                  "kinematic and single_track: yaw rate difference 0\\.[0-9]+ rad/s exceeds 1e-06 "
                  "rad/s at s = [0-9.]+ m, t = [0-9.]+ s")));
  EXPECT_EQ(result.pairs[0].differences.rows() > 50, true);
}

TEST(CompareRun, IsJudgedByTolerancesInstead) {
  const RunResult run =
      Turn("kinematic, single_track",
           "expect: {between: [{plants: [single_track, kinematic], position_max: 0}]}\n");
  EXPECT_FALSE(CompareRun(run, {}).verdict.passed);
  EXPECT_TRUE(CompareRun(run, DifferenceBounds{.position_max = 1.0}).verdict.passed);
  EXPECT_TRUE(CompareRun(run, DifferenceBounds{}).verdict.passed);
  EXPECT_FALSE(CompareRun(run, DifferenceBounds{.heading_max = 1e-9}).verdict.passed);
}

TEST(CompareRun, HoldsThePairToTheTightestOfAllItsBounds) {
  const RunResult run = Turn("kinematic, single_track",
                             "expect:\n  between:\n"
                             "    - {plants: [kinematic, single_track], position_max: 5, "
                             "heading_max: 1}\n"
                             "    - {plants: [single_track, kinematic], position_max: 2, "
                             "yaw_rate_max: 3}\n"
                             "    - {plants: [kinematic, single_track], position_max: 4}\n");
  const DifferenceBounds bounds = CompareRun(run, {}).pairs.at(0).bounds;
  EXPECT_EQ(bounds.position_max, 2.0);
  EXPECT_EQ(bounds.heading_max, 1.0);
  EXPECT_EQ(bounds.yaw_rate_max, 3.0);
  EXPECT_FALSE(bounds.steering_max);
}

TEST(CompareRun, FailsDrivesThatDoNotEndAsExpected) {
  RunResult run = Turn("kinematic, single_track", "expect: {metrics: [{metric: time, max: 0}]}\n");
  EXPECT_FALSE(run.verdict.passed);
  EXPECT_TRUE(CompareRun(run, {}).verdict.passed);  // only the statuses of the plants are judged
  run.metrics[1].status = DriveStatus::kDiverged;
  EXPECT_THAT(
      CompareRun(run, {}).verdict.failures,
      ElementsAre(testing::StartsWith("single_track: did not complete the run: diverged at ")));
  run.scenario.expect.all.metrics = {{.metric = "status", .equals = "diverged"}};
  EXPECT_THAT(CompareRun(run, {}).verdict.failures,
              ElementsAre(testing::StartsWith("kinematic: status is arrived instead of diverged "
                                              "at the end, s = ")));
}

TEST(CompareRun, FailsWithoutAPlan) {
  RunResult run;
  run.plan = MakeFeasible({.status = PlanStatus::kUTurn}, {});
  run.verdict = {.passed = false, .failures = {"no plan"}};
  const RunComparison result = CompareRun(run, {});
  EXPECT_FALSE(result.verdict.passed);
  EXPECT_THAT(result.verdict.failures, ElementsAre("no plan"));
  EXPECT_THAT(result.pairs, IsEmpty());
}

TEST(CompareFolders, OfOneRunComparesItsPlants) {
  const TempFolder folder;
  const fs::path run =
      Line(folder, "r", 0.0,
           {{"kinematic", "arrived"}, {"mujoco", "arrived"}, {"single_track", "arrived"}});
  EXPECT_THAT(
      Names(CompareFolders({run}, {}, {})),
      ElementsAre("kinematic - mujoco", "kinematic - single_track", "mujoco - single_track"));
  EXPECT_THAT(Names(CompareFolders({run}, {"single_track", "mujoco"}, {})),
              ElementsAre("single_track - mujoco"));
  EXPECT_EQ(ErrorMessage([&] { CompareFolders({run}, {"mujoco"}, {}); }),
            run.string() + ": only mujoco; comparing needs two plants or a second run");
  EXPECT_EQ(ErrorMessage([&] {
              CompareFolders({run}, {"mujoco", "car"}, {});
            }),
            run.string() + ": the run has no plant car; it has: kinematic, mujoco, single_track");
}

TEST(CompareFolders, OfTwoRunsComparesThePlantsThatBothHave) {
  const TempFolder folder;
  const fs::path a = Line(folder, "a", 0.0, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  const fs::path b = Line(folder, "b", 0.25, {{"mujoco", "arrived"}, {"single_track", "arrived"}});
  const RunComparison result = CompareFolders({a, b}, {}, DifferenceBounds{.position_max = 0.2});
  EXPECT_THAT(Names(result), ElementsAre("a/mujoco - b/mujoco"));
  EXPECT_EQ(result.pairs[0].comparison.position.max, 0.25);
  EXPECT_THAT(
      result.verdict.failures,
      ElementsAre(
          "a/mujoco and b/mujoco: position difference 0.25 m exceeds 0.2 m at s = 0 m, t = 0 s"));
  EXPECT_TRUE(CompareFolders({a, b}, {}, DifferenceBounds{.position_max = 0.25}).verdict.passed);
  EXPECT_THAT(Names(CompareFolders({a, b}, {"kinematic", "single_track"}, {})),
              ElementsAre("a/kinematic - b/single_track"));
  EXPECT_EQ(ErrorMessage([&] {
              CompareFolders({a, b}, {"kinematic"}, {});
            }),
            b.string() + ": the run has no plant kinematic; it has: mujoco, single_track");
  const fs::path c = Line(folder, "c", 0.0, {{"kinematic", "arrived"}});
  EXPECT_EQ(ErrorMessage([&] {
              CompareFolders({b, c}, {}, {});
            }),
            c.string() + ": no plant in common with " + b.string() +
                "; plants: mujoco, single_track and kinematic");
}

TEST(CompareFolders, OfOneRunIsJudgedByWhatItsScenarioExpects) {
  const TempFolder folder;
  const fs::path run = Line(folder, "r", 0.0, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  folder.Write("r/mujoco.csv",
               "t_s,x_m,y_m,yaw_rad,yaw_rate_radps,steering_rad,s_m\n0,0,2,0,0,0,0\n5,10,2,0,0,0,"
               "10\n");
  folder.Write("r/scenario.resolved.yaml",
               "schema: 1\nexpect: {between: [{plants: [mujoco, kinematic], position_max: 1}]}\n");
  EXPECT_THAT(
      CompareFolders({run}, {}, {}).verdict.failures,
      ElementsAre("kinematic and mujoco: position difference 2 m exceeds 1 m at s = 0 m, t = 0 s"));
  EXPECT_TRUE(CompareFolders({run}, {}, DifferenceBounds{.position_max = 3}).verdict.passed);
  // No expectation compares the two runs, so nothing is judged.
  EXPECT_FALSE(CompareFolders({run, run}, {}, {}).judged());
}

/// A plan of 10 m along y = `offset`.
void WritePlanAt(const TempFolder& folder, const std::string& run, double offset, double speed) {
  folder.Write(run + "/plan.csv",
               fmt::format("s_m,x_m,y_m,yaw_rad,curvature_radpm,speed_mps,direction\n"
                           "0,0,{0},0,0,{1},1\n10,10,{0},0,0,{1},1\n",
                           offset, speed));
}

TEST(CompareFolders, NotesThatTheRunsHadDifferentPlans) {
  const TempFolder folder;
  const fs::path a = Line(folder, "a", 0.0, {{"kinematic", "arrived"}});
  const fs::path b = Line(folder, "b", 0.0, {{"kinematic", "arrived"}});
  const auto notes = [&] { return CompareFolders({a, b}, {}, {}).verdict.notes; };
  EXPECT_THAT(notes(), IsEmpty());
  WritePlanAt(folder, "a", 0.0, 3.0);
  EXPECT_THAT(notes(), ElementsAre("only a followed a plan"));
  WritePlanAt(folder, "b", 1e-9, 3.0);
  EXPECT_THAT(notes(), IsEmpty());  // rounding
  WritePlanAt(folder, "b", 0.0, 4.0);
  EXPECT_THAT(notes(), ElementsAre("the runs follow the same path at different speeds"));
  WritePlanAt(folder, "b", 2.0, 3.0);
  EXPECT_THAT(
      notes(),
      ElementsAre(
          "the runs follow different paths, 10 m and 10 m long, up to 2 m apart at s = 0 m"));
}

TEST(CompareFolders, RefusesPlantsListedTwiceAndRunsThatDidNotDrive) {
  const TempFolder folder;
  const fs::path run = Line(folder, "r", 0.0, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  const auto told = [&](const std::vector<fs::path>& runs, const std::vector<std::string>& plants) {
    return ErrorMessage([&] { CompareFolders(runs, plants, {}); });
  };
  EXPECT_EQ(told({run}, {"kinematic", "kinematic"}), "--plants: 'kinematic' is listed twice");
  EXPECT_EQ(told({run, run}, {"kinematic", "mujoco", "kinematic"}),
            "--plants: 'kinematic' is listed twice");
  // In a comparison of two runs, the first name belongs to the first run, the second to the second.
  EXPECT_THAT(Names(CompareFolders({run, run}, {"mujoco", "mujoco"}, {})), testing::SizeIs(1));
  folder.Write("none/metrics.json", R"({"complete": true, "plants": {}})");
  EXPECT_EQ(told({folder.path() / "none"}, {}),
            (folder.path() / "none").string() + ": the run has no logs: it had no plan");
}

TEST(CompareFolders, OfDrivesThatEndedDifferentlyKeepsNoTolerance) {
  const TempFolder folder;
  const fs::path run = Line(folder, "r", 0.0, {{"kinematic", "arrived"}, {"mujoco", "collided"}});
  const char* const ends = "end status differs: kinematic arrived, mujoco collided";
  const RunComparison shown = CompareFolders({run}, {}, {});
  EXPECT_TRUE(shown.verdict.passed);
  EXPECT_THAT(shown.verdict.notes, ElementsAre(ends));
  const RunComparison judged = CompareFolders({run}, {}, DifferenceBounds{.position_max = 1.0});
  EXPECT_FALSE(judged.verdict.passed);
  EXPECT_THAT(judged.verdict.failures, ElementsAre(ends));
}

TEST(ParseTolerances, ReadsEachQuantity) {
  const DifferenceBounds bounds =
      ParseTolerances({"position=0.1", "heading=2e-2", "yaw_rate=3", "steering=0"});
  EXPECT_EQ(bounds.position_max, 0.1);
  EXPECT_EQ(bounds.heading_max, 0.02);
  EXPECT_EQ(bounds.yaw_rate_max, 3.0);
  EXPECT_EQ(bounds.steering_max, 0.0);
  EXPECT_FALSE(ParseTolerances({}).any());
}

TEST(ParseTolerances, RefusesEverythingElse) {
  const auto told = [](const std::string& text) {
    return ErrorMessage([&] { ParseTolerances({text}); });
  };
  EXPECT_EQ(told("positon=1"), "--tolerance: unknown 'positon'; did you mean 'position'?");
  EXPECT_EQ(ErrorMessage([] {
              ParseTolerances({"position=0.1", "heading=1", "position=0.2"});
            }),
            "--tolerance: position: given twice");
  EXPECT_EQ(told("position"),
            "--tolerance: expected NAME=VALUE such as position=0.1, found 'position'");
  for (const char* value : {"", "-1", "nan", "inf", "1m", "1,5", "1e999"}) {
    EXPECT_EQ(
        told(std::string("heading=") + value),
        fmt::format("--tolerance: heading: expected a number of at least 0, found '{}'", value));
  }
}

TEST(WriteComparison, LeavesTheFiguresAndTheCurves) {
  const TempFolder folder;
  const fs::path a = Line(folder, "a", 0.0, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  const fs::path b = Line(folder, "b", 0.5, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  WriteComparison(CompareFolders({a, b}, {}, DifferenceBounds{.position_max = 0.1}),
                  folder.path() / "c");
  const auto json = nlohmann::json::parse(ReadFile(folder.path() / "c/compare.json"));
  ASSERT_EQ(json["pairs"].size(), 2U);
  EXPECT_EQ(json["pairs"][1]["plants"][0], "a/mujoco");
  EXPECT_EQ(json["pairs"][1]["position"]["max"], 0.5);
  EXPECT_EQ(json["pairs"][1]["position"]["rms"], 0.5);
  EXPECT_EQ(json["pairs"][1]["to_s"], 10.0);
  EXPECT_EQ(json["pairs"][1]["tolerances"], nlohmann::json({{"position_max", 0.1}}));
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["verdict"]["passed"], false);
  EXPECT_EQ(json["verdict"]["failures"].size(), 2U);
  EXPECT_TRUE(json["versions"].contains("trackbed"));
  const Table table = ReadCsv(folder.path() / "c/compare.csv");
  EXPECT_THAT(table.Column("pair"), ElementsAre(0.0, 0.0, 1.0, 1.0));
  EXPECT_THAT(table.Column("s_m"), ElementsAre(0.0, 10.0, 0.0, 10.0));
  EXPECT_THAT(table.Column("y_m"), testing::Each(0.5));
  // The paths of the runs are relative to the output folder, even if absolute paths were given.
  EXPECT_EQ(json["runs"], nlohmann::json({"../a", "../b"}));
  RunComparison moved{.runs = {fs::relative(a)}};
  folder.Write("c/report.html", std::string(kPageMark));
  WriteComparison(moved, folder.path() / "c");
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder.path() / "c/compare.json"))["runs"],
            nlohmann::json({"../a"}));
  EXPECT_FALSE(fs::exists(folder.path() / "c/report.html"));
  WriteComparison(RunComparison{}, folder.path() / "d");
  EXPECT_FALSE(nlohmann::json::parse(ReadFile(folder.path() / "d/compare.json")).contains("runs"));
}

TEST(WriteComparison, SaysNothingOfPassingWhereNothingWasJudged) {
  const TempFolder folder;
  const fs::path a = Line(folder, "a", 0.0, {{"kinematic", "arrived"}});
  const fs::path b = Line(folder, "b", 0.5, {{"kinematic", "arrived"}});
  const auto written = [&](const std::optional<DifferenceBounds>& bounds) {
    WriteComparison(CompareFolders({a, b}, {}, bounds), folder.path() / "c");
    return nlohmann::json::parse(ReadFile(folder.path() / "c/compare.json"));
  };
  EXPECT_EQ(written({})["status"], "compared");
  EXPECT_TRUE(written({})["verdict"]["passed"].is_null());
  EXPECT_EQ(written(DifferenceBounds{.heading_max = 0.0})["status"], "passed");
  EXPECT_EQ(written(DifferenceBounds{.heading_max = 0.0})["verdict"]["passed"], true);
}

TEST(CompareFolders, NamesThePlantsThatOneRunAloneDrove) {
  const TempFolder folder;
  const fs::path both =
      Line(folder, "both", 0.0, {{"kinematic", "arrived"}, {"mujoco", "arrived"}});
  const fs::path one = Line(folder, "one", 0.0, {{"kinematic", "arrived"}});
  EXPECT_THAT(CompareFolders({both, one}, {}, {}).verdict.notes,
              testing::Contains("not compared: mujoco, only in both"));
  EXPECT_THAT(CompareFolders({both, one}, {"kinematic"}, {}).verdict.notes,
              testing::Not(testing::Contains(testing::HasSubstr("not compared"))));
}

}  // namespace
}  // namespace trackbed

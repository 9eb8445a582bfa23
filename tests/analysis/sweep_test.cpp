// Tests sweeps with an artificial run function instead of simulations: order of the rows, seeds,
// bisection, threads, interruption and errors.

#include "trackbed/analysis/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "tests/analysis/studies.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/study_check.h"

namespace trackbed {
namespace {

SweepResult SweepStudy(const TempFolder& folder, const std::string& keys,
                       const RunScenarioOnce& run, const SweepOptions& options = {}) {
  return RunSweep(StudyPoints(MakeStudy(folder, keys)), run, options);
}

/// An artificial run, without a simulation, that passes up to a speed that decreases with the seed.
std::optional<RunOutcome> UpToASpeed(const Scenario& scenario) {
  const double limit = 20.0 - static_cast<double>(scenario.seed);
  const bool passed = scenario.mission.speed <= limit;
  return RunOutcome{
      .status = passed ? "passed" : "failed",
      .passed = passed,
      .outputs = {{"metrics.kinematic.distance", ShortestText(2.0 * scenario.mission.speed)}}};
}

TEST(Sweep, HasARowForEveryPointInTheGridsOrder) {
  const TempFolder folder;
  const SweepResult sweep = SweepStudy(folder, R"(vary:
  mission.speed: {from: 10, to: 20, steps: 3}
  drive.plants: [[kinematic], [kinematic, mujoco]]
outputs: [metrics.kinematic.distance, metrics.mujoco.distance]
)",
                                       UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,drive.plants,status,metrics.kinematic.distance,metrics.mujoco.distance,"
            "reason\n"
            "10,[kinematic],passed,20,,\n"
            "10,\"[kinematic, mujoco]\",passed,20,,\n"
            "15,[kinematic],passed,30,,\n"
            "15,\"[kinematic, mujoco]\",passed,30,,\n"
            "20,[kinematic],passed,40,,\n"
            "20,\"[kinematic, mujoco]\",passed,40,,\n");
  EXPECT_TRUE(sweep.summary.complete());
  EXPECT_EQ(sweep.summary.runs, 6U);
  EXPECT_EQ(sweep.summary.passed, 6U);
}

TEST(Sweep, LeavesCellsOfAListEmptyWhereAPointSaysNothing) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepStudy(folder, "list: [{mission.speed: 19, seed: 1}, {seed: 2}, {world.friction: 0.5}]\n",
                 UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,seed,world.friction,status,reason\n"
            "19,1,,passed,\n"
            ",2,,passed,\n"
            ",,0.5,passed,\n");
}

TEST(Sweep, CountsTheSeedUpWhereItRepeats) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepStudy(folder, "set: {seed: 4}\nvary: {mission.speed: [15, 3]}\nrepeat: 3\n", UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,seed,status,reason\n"
            "15,4,passed,\n15,5,passed,\n15,6,failed,\n"
            "3,4,passed,\n3,5,passed,\n3,6,passed,\n");
  EXPECT_EQ(sweep.summary.passed, 5U);
}

TEST(Sweep, BisectsAtEveryPoint) {
  const TempFolder folder;
  // The highest passing speeds 20, 15 and 8 m/s are above, between and below the ends of the
  // bisected range.
  const SweepResult sweep = SweepStudy(folder, R"(vary: {seed: [0, 5, 12]}
bisect: {key: mission.speed, from: 10, to: 18, tolerance: 0.5}
outputs: [metrics.kinematic.distance]
)",
                                       UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "seed,mission.speed,status,runs,metrics.kinematic.distance,reason\n"
            "0,18,passes_at_to,2,36,\n"
            "5,15,found,6,30,\n"
            "12,,fails_at_from,1,,\n");
  EXPECT_EQ(sweep.summary.runs, 9U);
  EXPECT_EQ(sweep.summary.passed, 2U);
  const auto& bisection = sweep.description["bisections"][1];
  EXPECT_EQ(bisection["point"]["seed"], 5);
  EXPECT_EQ(bisection["value"], 15);
  EXPECT_EQ(bisection["trials"].dump(),
            R"([{"value":10.0,"passed":true},{"value":18.0,"passed":false},)"
            R"({"value":14.0,"passed":true},{"value":16.0,"passed":false},)"
            R"({"value":15.0,"passed":true},{"value":15.5,"passed":false}])");
  EXPECT_FALSE(sweep.description["bisections"][2].contains("value"));
}

TEST(Sweep, SaysWhatFailsAboveTheHighestValueThatPasses) {
  const TempFolder folder;
  const RunScenarioOnce run = [](const Scenario& scenario) -> std::optional<RunOutcome> {
    RunOutcome outcome = *UpToASpeed(scenario);
    if (!outcome.passed) {
      outcome.reason = ShortestText(scenario.mission.speed) + " is too fast";
    }
    return outcome;
  };
  const SweepResult sweep = SweepStudy(folder, R"(vary: {seed: [0, 5, 12]}
bisect: {key: mission.speed, from: 10, to: 18, tolerance: 0.5}
)",
                                       run);
  // The highest passing speeds 20, 15 and 8 m/s are above, between and below the ends of the
  // bisected range.
  EXPECT_EQ(sweep.table.ToCsv(),
            "seed,mission.speed,status,runs,reason\n"
            "0,18,passes_at_to,2,\n"
            "5,15,found,6,at 15.5: 15.5 is too fast\n"
            "12,,fails_at_from,1,at 10: 10 is too fast\n");
}

TEST(Sweep, BisectsEveryRepetitionWithItsOwnSeed) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepStudy(folder,
                 "repeat: 2\nset: {seed: 6}\n"
                 "bisect: {key: mission.speed, from: 10, to: 18, tolerance: 1}\n",
                 UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,seed,status,runs,reason\n14,6,found,5,\n13,7,found,5,\n");
}

TEST(Sweep, DescribesTheStudyThatWasRun) {
  const TempFolder folder;
  const Study study = MakeStudy(folder, R"(set: {drive.plants: [kinematic], world.friction: 0.5}
vary: {mission.speed: [1, 2.50], control.law: [linear]}
list: [{seed: 3}]
outputs: [verdict.passed]
)",
                                {"world.friction=0.7"});
  auto json = RunSweep(StudyPoints(study), UpToASpeed, {}).description;
  EXPECT_EQ(json["study"], "study");
  EXPECT_EQ(json["set"].dump(), R"({"drive.plants":"[kinematic]","world.friction":0.5})");
  EXPECT_EQ(json["overrides"].dump(), R"(["world.friction=0.7"])");
  EXPECT_EQ(json["vary"].dump(), R"({"mission.speed":[1,2.5],"control.law":["linear"]})");
  EXPECT_EQ(json["list"].dump(), R"([{"seed":3}])");
  EXPECT_EQ(json["outputs"].dump(), R"(["verdict.passed"])");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["rows"], 2);
  EXPECT_EQ(json["versions"], Versions());
}

TEST(Sweep, IsTheSameForAnyNumberOfJobs) {
  const TempFolder folder;
  const std::string keys =
      "vary: {mission.speed: {from: 1, to: 25, steps: 40}}\nrepeat: 2\n"
      "outputs: [metrics.kinematic.distance]\n";
  const SweepResult one = SweepStudy(folder, keys, UpToASpeed, {.jobs = 1});
  EXPECT_EQ(one.table.rows().size(), 80U);
  for (const int jobs : {2, 4, 200}) {
    // The first run waits until another run has ended, which requires a second thread.
    std::atomic<int> ended{0};
    const RunScenarioOnce run = [&](const Scenario& scenario) {
      if (scenario.mission.speed == 1.0 && scenario.seed == 0) {
        ended.wait(0);
      }
      ++ended;
      ended.notify_all();
      return UpToASpeed(scenario);
    };
    const SweepResult many = SweepStudy(folder, keys, run, {.jobs = jobs});
    EXPECT_EQ(many.table.ToCsv(), one.table.ToCsv());
    EXPECT_EQ(many.description.dump(), one.description.dump());
  }
}

TEST(Sweep, TellsHowFarItIs) {
  const TempFolder folder;
  std::vector<double> told;
  SweepStudy(folder, "repeat: 4\n", UpToASpeed,
             {.jobs = 2, .progress = [&](double fraction) { told.push_back(fraction); }});
  EXPECT_THAT(told, testing::ElementsAre(0.25, 0.5, 0.75, 1.0));
}

TEST(Sweep, KeepsTheRowsThatWereCompleteWhenItIsInterrupted) {
  const TempFolder folder;
  int runs = 0;
  const RunScenarioOnce third_is_cut_off =
      [&](const Scenario& scenario) -> std::optional<RunOutcome> {
    return ++runs == 3 ? std::nullopt : UpToASpeed(scenario);
  };
  const SweepResult sweep =
      SweepStudy(folder, "vary: {mission.speed: [1, 2, 3, 4]}\n", third_is_cut_off);
  EXPECT_EQ(sweep.table.ToCsv(), "mission.speed,status,reason\n1,passed,\n2,passed,\n");
  EXPECT_FALSE(sweep.summary.complete());
  EXPECT_EQ(sweep.description["complete"], false);
  EXPECT_EQ(sweep.description["rows_expected"], 4);
  EXPECT_EQ(runs, 3);  // no further run began
}

TEST(Sweep, BeginsNothingOnceItIsInterrupted) {
  const TempFolder folder;
  std::atomic<int> runs{0};
  const RunScenarioOnce run = [&](const Scenario& scenario) {
    ++runs;
    return UpToASpeed(scenario);
  };
  // A bisection whose last trials are missing has no row.
  const SweepResult sweep =
      SweepStudy(folder, "bisect: {key: mission.speed, from: 10, to: 30, tolerance: 0.1}\n", run,
                 {.interrupted = [&] { return runs == 4; }});
  EXPECT_EQ(sweep.table.rows().size(), 0U);
  EXPECT_EQ(runs, 4);
}

TEST(Sweep, ThrowsOnWhatARunThrows) {
  const TempFolder folder;
  const RunScenarioOnce run = [](const Scenario& scenario) -> std::optional<RunOutcome> {
    if (scenario.seed == 3) {
      throw RunError("no more");
    }
    return UpToASpeed(scenario);
  };
  EXPECT_THROW(SweepStudy(folder, "repeat: 9\n", run, {.jobs = 3}), RunError);
}

TEST(Sweep, HasARowWithAReasonForAPointThatIsRefused) {
  const TempFolder folder;
  const Study study = MakeStudy(folder, "vary: {mission.speed: [1, 1000, 2]}\n");
  EXPECT_THROW(CheckPoints(StudyPoints(study), true), InputError);
  EXPECT_NO_THROW(CheckPoints(StudyPoints(study), false));
  const SweepResult sweep = RunSweep(StudyPoints(study), UpToASpeed, {.jobs = 2});
  EXPECT_EQ(
      sweep.table.ToCsv(),
      "mission.speed,status,reason\n1,passed,\n"
      "1000,refused,mission.speed: 1000 is out of range; must be at least 0.1 and at most 100\n"
      "2,passed,\n");
  EXPECT_TRUE(sweep.summary.complete());
  EXPECT_EQ(sweep.summary.runs, 2U);
  EXPECT_EQ(sweep.summary.refused, 1U);
  // A study with only rejected points is invalid input.
  const Study bad = MakeStudy(folder, "vary: {mission.speed: [1000, 2000]}\n");
  EXPECT_THROW(CheckPoints(StudyPoints(bad), false), InputError);
}

TEST(Sweep, HasARowWithAReasonForARunThatThrows) {
  const TempFolder folder;
  const RunScenarioOnce run = [](const Scenario& scenario) -> std::optional<RunOutcome> {
    if (scenario.seed == 1) {
      throw InputError(Problem{.key = "drive.timestep", .message = "too long"});
    }
    if (scenario.seed == 2) {
      throw InternalError("no matrix");
    }
    RunOutcome outcome = *UpToASpeed(scenario);
    outcome.reason = "as told";
    return outcome;
  };
  const SweepResult sweep = SweepStudy(folder, "vary: {seed: [0, 1, 2]}\n", run);
  EXPECT_EQ(sweep.table.ToCsv(),
            "seed,status,reason\n0,passed,as told\n1,refused,drive.timestep: too long\n"
            "2,error,no matrix\n");
  EXPECT_EQ(sweep.summary.refused, 1U);
  EXPECT_EQ(sweep.summary.errors, 1U);
  EXPECT_EQ(sweep.description["errors"], 1);
  const SweepResult bisected = SweepStudy(
      folder, "vary: {seed: [1]}\nbisect: {key: mission.speed, from: 10, to: 18, tolerance: 1}\n",
      run);
  EXPECT_EQ(bisected.table.ToCsv(),
            "seed,mission.speed,status,runs,reason\n1,,refused,0,drive.timestep: too long\n");
}

TEST(Sweep, WritesWholeFiles) {
  const TempFolder folder;
  const StudyPoints points(MakeStudy(folder, "repeat: 2\n"));
  SweepRecords records = SweepRecords::InMemory(SweepHeader(points));
  RunRows(points, UpToASpeed, records, {});
  const SweepSummary summary = WriteSweep(records, {}, folder.path() / "out");
  EXPECT_TRUE(summary.complete());
  EXPECT_EQ(summary.passed, 2U);
  EXPECT_EQ(ReadFile(folder.path() / "out/sweep.csv"),
            "seed,status,reason\n0,passed,\n1,passed,\n");
  EXPECT_EQ(nlohmann::ordered_json::parse(ReadFile(folder.path() / "out/sweep.json")),
            RunSweep(points, UpToASpeed, {}).description);
  EXPECT_THROW(WriteSweep(records, {}, folder.path() / "study.yaml" / "x"), RunError);
}

}  // namespace
}  // namespace trackbed

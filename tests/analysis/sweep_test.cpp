#include "trackbed/analysis/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

/// A study of scenarios/winding.yaml with these keys.
Study StudyOf(const TempFolder& folder, const std::string& keys,
              const std::vector<Override>& overrides = {}) {
  const std::string text =
      "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR "/scenarios/winding.yaml\n" + keys;
  return ReadStudy(folder.Write("study.yaml", text), overrides);
}

SweepResult SweepOf(const TempFolder& folder, const std::string& keys, const RunScenarioOnce& run,
                    const SweepOptions& options = {}) {
  const Study study = StudyOf(folder, keys);
  return RunSweep(study, ReadPoints(study), run, options);
}

/// Passes up to a speed that falls with the seed; nothing is driven.
std::optional<RunOutcome> UpToASpeed(const Scenario& scenario) {
  const double limit = 20.0 - static_cast<double>(scenario.seed);
  const bool passed = scenario.mission.speed <= limit;
  return RunOutcome{
      .status = passed ? "passed" : "failed",
      .passed = passed,
      .outputs = {{"metrics.kinematic.distance", ShortestText(2.0 * scenario.mission.speed)}}};
}

/// The error of a call, without the folder's name.
template <typename Call>
std::string ErrorOf(const TempFolder& folder, const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string name = folder.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(name)) != std::string::npos;) {
      message.erase(at, name.size());
    }
    return message;
  }
  return "no error";
}

TEST(Sweep, HasARowForEveryPointInTheGridsOrder) {
  const TempFolder folder;
  const SweepResult sweep = SweepOf(folder, R"(vary:
  mission.speed: {from: 10, to: 20, steps: 3}
  drive.plants: [[kinematic], [kinematic, mujoco]]
outputs: [metrics.kinematic.distance, metrics.mujoco.distance]
)",
                                    UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,drive.plants,status,metrics.kinematic.distance,metrics.mujoco.distance\n"
            "10,[kinematic],passed,20,\n"
            "10,\"[kinematic, mujoco]\",passed,20,\n"
            "15,[kinematic],passed,30,\n"
            "15,\"[kinematic, mujoco]\",passed,30,\n"
            "20,[kinematic],passed,40,\n"
            "20,\"[kinematic, mujoco]\",passed,40,\n");
  EXPECT_TRUE(sweep.complete());
  EXPECT_EQ(sweep.runs, 6U);
  EXPECT_EQ(sweep.passed, 6U);
}

TEST(Sweep, LeavesCellsOfAListEmptyWhereAPointSaysNothing) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepOf(folder, "list: [{mission.speed: 19, seed: 1}, {seed: 2}, {world.friction: 0.5}]\n",
              UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,seed,world.friction,status\n"
            "19,1,,passed\n"
            ",2,,passed\n"
            ",,0.5,passed\n");
}

TEST(Sweep, CountsTheSeedUpWhereItRepeats) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepOf(folder, "set: {seed: 4}\nvary: {mission.speed: [15, 3]}\nrepeat: 3\n", UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "mission.speed,seed,status\n"
            "15,4,passed\n15,5,passed\n15,6,failed\n"
            "3,4,passed\n3,5,passed\n3,6,passed\n");
  EXPECT_EQ(sweep.passed, 5U);
}

TEST(Sweep, BisectsAtEveryPoint) {
  const TempFolder folder;
  // Limits 20, 15 and 8: above, between and below the ends.
  const SweepResult sweep = SweepOf(folder, R"(vary: {seed: [0, 5, 12]}
bisect: {key: mission.speed, from: 10, to: 18, tolerance: 0.5}
outputs: [metrics.kinematic.distance]
)",
                                    UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(),
            "seed,mission.speed,status,runs,metrics.kinematic.distance\n"
            "0,18,passes_at_to,2,36\n"
            "5,15,found,6,30\n"
            "12,,fails_at_from,1,\n");
  EXPECT_EQ(sweep.runs, 9U);
  EXPECT_EQ(sweep.passed, 2U);
  const auto& bisection = sweep.description["bisections"][1];
  EXPECT_EQ(bisection["point"]["seed"], 5);
  EXPECT_EQ(bisection["value"], 15);
  EXPECT_EQ(bisection["trials"].dump(),
            R"([{"value":10.0,"passed":true},{"value":18.0,"passed":false},)"
            R"({"value":14.0,"passed":true},{"value":16.0,"passed":false},)"
            R"({"value":15.0,"passed":true},{"value":15.5,"passed":false}])");
  EXPECT_FALSE(sweep.description["bisections"][2].contains("value"));
}

TEST(Sweep, BisectsEveryRepetitionWithItsOwnSeed) {
  const TempFolder folder;
  const SweepResult sweep =
      SweepOf(folder,
              "repeat: 2\nset: {seed: 6}\n"
              "bisect: {key: mission.speed, from: 10, to: 18, tolerance: 1}\n",
              UpToASpeed);
  EXPECT_EQ(sweep.table.ToCsv(), "mission.speed,seed,status,runs\n14,6,found,5\n13,7,found,5\n");
}

TEST(Sweep, DescribesTheStudyThatWasRun) {
  const TempFolder folder;
  const Study study = StudyOf(folder, R"(set: {drive.plants: [kinematic], world.friction: 0.5}
vary: {mission.speed: [1, 2.50], control.law: [linear]}
list: [{seed: 3}]
outputs: [verdict.passed]
)",
                              {"world.friction=0.7"});
  auto json = RunSweep(study, ReadPoints(study), UpToASpeed, {}).description;
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
  const SweepResult one = SweepOf(folder, keys, UpToASpeed, {.jobs = 1});
  EXPECT_EQ(one.table.rows().size(), 80U);
  for (const int jobs : {2, 4, 200}) {
    // The first run ends after another one, which only another thread can bring to its end.
    std::atomic<int> ended{0};
    const RunScenarioOnce run = [&](const Scenario& scenario) {
      if (scenario.mission.speed == 1.0 && scenario.seed == 0) {
        ended.wait(0);
      }
      ++ended;
      ended.notify_all();
      return UpToASpeed(scenario);
    };
    const SweepResult many = SweepOf(folder, keys, run, {.jobs = jobs});
    EXPECT_EQ(many.table.ToCsv(), one.table.ToCsv());
    EXPECT_EQ(many.description.dump(), one.description.dump());
  }
}

TEST(Sweep, TellsHowFarItIs) {
  const TempFolder folder;
  std::vector<double> told;
  SweepOf(folder, "repeat: 4\n", UpToASpeed,
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
      SweepOf(folder, "vary: {mission.speed: [1, 2, 3, 4]}\n", third_is_cut_off);
  EXPECT_EQ(sweep.table.ToCsv(), "mission.speed,status\n1,passed\n2,passed\n");
  EXPECT_FALSE(sweep.complete());
  EXPECT_EQ(sweep.description["complete"], false);
  EXPECT_EQ(sweep.description["rows_expected"], 4);
  EXPECT_EQ(runs, 3);  // nothing more was begun
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
      SweepOf(folder, "bisect: {key: mission.speed, from: 10, to: 30, tolerance: 0.1}\n", run,
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
  EXPECT_THROW(SweepOf(folder, "repeat: 9\n", run, {.jobs = 3}), RunError);
}

TEST(Sweep, WritesWholeFiles) {
  const TempFolder folder;
  const SweepResult sweep = SweepOf(folder, "repeat: 2\n", UpToASpeed);
  WriteSweep(sweep, folder.path() / "out");
  EXPECT_EQ(ReadFile(folder.path() / "out/sweep.csv"), "seed,status\n0,passed\n1,passed\n");
  EXPECT_EQ(nlohmann::ordered_json::parse(ReadFile(folder.path() / "out/sweep.json")),
            sweep.description);
  EXPECT_THROW(WriteSweep(sweep, folder.path() / "study.yaml" / "x"), RunError);
}

TEST(CheckStudy, NamesOutputsThatNoRunCanHave) {
  const TempFolder folder;
  const auto error = [&](const std::string& keys) {
    return ErrorOf(folder, [&] { CheckStudy(StudyOf(folder, "repeat: 2\noutputs:\n" + keys)); });
  };
  EXPECT_EQ(error("  - metrics.mujoco.cros_track.max\n  - verdict.passed\n  - plan.length\n"),
            "study.yaml:6:5: outputs[0]: no run can have 'metrics.mujoco.cros_track.max'; did you "
            "mean 'metrics.mujoco.cross_track.max'?\n"
            "study.yaml:8:5: outputs[2]: no run can have 'plan.length'; did you mean "
            "'plan.length_m'?");
  // There are five waypoints, so three turns; no obstacles; and nothing but winding's plants.
  EXPECT_THAT(error("  - metrics.mujoco.turns[3].lateral_offset\n"),
              testing::HasSubstr("did you mean 'metrics.mujoco.turns[0].lateral_offset'?"));
  EXPECT_THAT(error("  - metrics.mujoco.clearance_min\n"), testing::HasSubstr("no run can have"));
  EXPECT_EQ(error("  - between.kinematic.mujoco.position.max\n  - verdict.failures\n"
                  "  - metrics.kinematic.turns[2].lateral_offset\n"),
            "no error");
}

TEST(CheckStudy, KnowsTheOutputsOfEveryPoint) {
  const TempFolder folder;
  const std::string box = "[{box: {x: 20, y: 3, length: 1, width: 1}}]";
  const CheckedStudy checked = CheckStudy(StudyOf(folder,
                                                  "list:\n  - {drive.plants: [kinematic]}\n"
                                                  "  - {drive.plants: [mujoco], "
                                                  "world.obstacles: " +
                                                      box +
                                                      "}\n"
                                                      "outputs: [metrics.kinematic.time, "
                                                      "metrics.mujoco.clearance_min]\n"));
  EXPECT_EQ(checked.points.size(), 2U);
  EXPECT_EQ(checked.cars.size(), 1U);  // one model at one timestep
}

TEST(CheckStudy, CompilesEveryCarThatThereIs) {
  const TempFolder folder;
  folder.Write("broken.xml", "<mujoco><worldbody/></mujoco>\n");
  const std::string broken = (folder.path() / "broken.xml").string();
  EXPECT_THAT(
      ErrorOf(folder,
              [&] {
                CheckStudy(StudyOf(folder, "vary: {vehicle.model: [prius, '" + broken + "']}\n"));
              }),
      testing::HasSubstr("broken.xml"));
}

/// A study that takes a tenth of a second a run.
const std::string kShort = R"(set: {drive.plants: [kinematic], expect: {max_cross_track: 0.05}}
vary: {control.distance: [1, 2.5, 5]}
outputs: [metrics.kinematic.status, metrics.kinematic.cross_track.max, verdict.failures]
)";

TEST(DriveOnce, ComesToWhatARunOfTheScenarioComesTo) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(StudyOf(folder, kShort));
  for (const StudyPoint& point : checked.points) {
    const std::optional<RunOutcome> outcome = DriveOnce(checked, point.scenario);
    ASSERT_TRUE(outcome.has_value());
    const RunResult run = RunMission(point.scenario);
    EXPECT_EQ(outcome->passed, run.verdict.passed);
    EXPECT_EQ(outcome->status, run.verdict.passed ? "passed" : "failed");
    EXPECT_EQ(outcome->outputs, OutputsOf(run));
    const Outputs& outputs = outcome->outputs;
    EXPECT_EQ(outputs.at("metrics.kinematic.cross_track.max"),
              ShortestText(run.metrics[0].tracking->cross_track_max));
    EXPECT_EQ(outputs.at("metrics.kinematic.status"), "arrived");
    EXPECT_EQ(outputs.at("verdict.passed"), run.verdict.passed ? "true" : "false");
    EXPECT_EQ(outputs.at("plan.length_m"), ShortestText(run.plan.reference.path.length()));
    // What a run has is among what it was said to be able to have.
    const std::vector<std::string> possible = PossibleOutputs(point.scenario);
    for (const auto& output : outputs) {
      EXPECT_THAT(possible, testing::Contains(output.first));
    }
  }
}

TEST(DriveOnce, TellsThatThereIsNoPlan) {
  const TempFolder folder;
  const CheckedStudy checked =
      CheckStudy(StudyOf(folder, "list: [{mission.waypoints: [[0, 0], [10, 0], [10, 10]]}]\n"));
  const std::optional<RunOutcome> outcome = DriveOnce(checked, checked.points[0].scenario);
  EXPECT_EQ(outcome->status, "no_plan");
  EXPECT_EQ(outcome->outputs.at("plan.status"), "turn_too_tight");
  EXPECT_EQ(outcome->outputs.count("plan.length_m"), 0U);
}

TEST(DriveOnce, EndsWithNothingWhenItIsInterrupted) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(StudyOf(folder, kShort));
  EXPECT_FALSE(DriveOnce(checked, checked.points[0].scenario, [] { return true; }).has_value());
}

TEST(DriveOnce, GivesTheSameSweepOnOneThreadAndOnFour) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(StudyOf(folder, R"(set: {drive.time_limit: 3}
vary:
  drive.plants: [[kinematic], [mujoco], [kinematic, mujoco]]
  world.obstacles: [[], [{box: {x: 20, y: 3, length: 1, width: 1}}]]
outputs:
  - metrics.kinematic.cross_track.rms
  - metrics.mujoco.lateral_acceleration_max
  - metrics.mujoco.clearance_min
  - between.kinematic.mujoco.position.max
)"));
  const RunScenarioOnce run = [&](const Scenario& scenario) {
    return DriveOnce(checked, scenario);
  };
  const SweepResult one = RunSweep(checked.study, checked.points, run, {.jobs = 1});
  const SweepResult four = RunSweep(checked.study, checked.points, run, {.jobs = 4});
  EXPECT_EQ(one.table.ToCsv(), four.table.ToCsv());
  EXPECT_EQ(one.description.dump(), four.description.dump());
  // The rows are not all alike, so that a mix-up would show.
  const auto& rows = one.table.rows();
  EXPECT_EQ((std::set<std::vector<std::string>>(rows.begin(), rows.end())).size(), rows.size());
  for (const auto& row : rows) {
    const bool both = row[0] == "[kinematic, mujoco]";
    EXPECT_EQ(row[6].empty(), !both) << row[0];
  }
}

TEST(PreviewDistance, TooFarAheadCutsTheCorners) {
  Study study =
      ReadStudy(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/studies/preview_distance.yaml",
                {"drive.timestep=0.004"});
  // Every third of its nine distances: 1, 2.5 and 5 m.
  std::vector<Setting>& distances = study.vary.at(0);
  distances = {distances.at(0), distances.at(3), distances.at(6)};
  const CheckedStudy checked = CheckStudy(study);
  const SweepResult sweep =
      RunSweep(checked.study, checked.points,
               [&](const Scenario& scenario) { return DriveOnce(checked, scenario); }, {.jobs = 2});
  const auto& rows = sweep.table.rows();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0][1], "passed");
  EXPECT_EQ(rows[1][1], "passed");
  EXPECT_EQ(rows[2][1], "failed");
  // To first order the car's offset e from the path obeys e'' + 2/L e' + 2/L^2 e = f, where an arc
  // of radius R that begins L ahead makes f grow as x^2/(L^2 R) over the L to its beginning and
  // then vanish: e rises to 0.104 L^2/R, 0.57 L into the arc. With 2.5 m ahead the car is back on
  // the path before the arc of 16.83 m ends. Higher orders are (L/R)^2 = 2 % of that; commands are
  // held for 20 ms and the servo lags by 15 ms, which is 4 % of L on the way: 10 % in all.
  const double expected = 0.104 * 2.5 * 2.5 / 16.83;
  for (const std::size_t cross_track : {2U, 3U}) {  // on both plants
    EXPECT_NEAR(std::stod(rows[1][cross_track]), expected, Tolerance(0.1 * expected));
    EXPECT_GT(std::stod(rows[2][cross_track]), 0.15);
    // Too near, the steering rate is not enough.
    EXPECT_GT(std::stod(rows[0][cross_track]), 2.0 * expected);
  }
}

}  // namespace
}  // namespace trackbed

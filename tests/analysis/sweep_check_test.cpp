#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/analysis/studies.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/robustness.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/study_reader.h"

/// Tests the checks of a study before it runs, and the execution of a single run.
namespace trackbed {
namespace {

TEST(CheckStudy, NamesOutputsThatNoRunCanHave) {
  const TempFolder folder;
  const auto error = [&](const std::string& keys) {
    return ErrorMessage(folder,
                        [&] { CheckStudy(MakeStudy(folder, "repeat: 2\noutputs:\n" + keys)); });
  };
  EXPECT_EQ(error("  - metrics.mujoco.cros_track.max\n  - verdict.passed\n  - plan.length\n"),
            "study.yaml:6:5: outputs[0]: unknown metric 'metrics.mujoco.cros_track.max'; did you "
            "mean 'metrics.mujoco.cross_track.max'?\n"
            "study.yaml:8:5: outputs[2]: unknown metric 'plan.length'; did you mean "
            "'plan.length_m'?");
  // The scenario has five waypoints and thus three turns, no obstacles, and only the plants of
  // winding.yaml.
  EXPECT_THAT(error("  - metrics.mujoco.turns[3].lateral_offset\n"),
              testing::HasSubstr("did you mean 'metrics.mujoco.turns[0].lateral_offset'?"));
  EXPECT_THAT(error("  - metrics.mujoco.clearance_min\n"), testing::HasSubstr("unknown metric "));
  EXPECT_EQ(error("  - between.kinematic.mujoco.position.max\n  - verdict.failures\n"
                  "  - metrics.kinematic.turns[2].lateral_offset\n"),
            "no error");
}

TEST(CheckStudy, NamesMetricsThatNoRunCanBeExpectedToHave) {
  const TempFolder folder;
  Study study = MakeStudy(folder,
                          "set: {expect.metrics: [{metric: maneuver.passed, equals: true}]}\n"
                          "repeat: 2\n");
  study.metrics = PossibleMetrics;
  EXPECT_THAT(ErrorMessage(folder, [&] { CheckStudy(study); }),
              testing::StartsWith("study.yaml:4:23: expect.metrics[0].metric: unknown metric "
                                  "'maneuver.passed'; allowed: status, "));
}

TEST(PossibleMetrics, AreThoseOfTheRun) {
  const Scenario scenario = ReadScenario(
      std::string(TRACKBED_SOURCE_DIR) + "/scenarios/disturbed.yaml", {"drive.plants=[kinematic]"});
  const std::vector<std::string> possible = PossibleMetrics(scenario);
  for (const auto& [path, value] : CollectOutputs(RunScenario(scenario))) {
    const std::string start = "metrics.kinematic.";
    if (path.starts_with(start)) {
      EXPECT_THAT(possible, testing::Contains(path.substr(start.size())));
    }
  }
  EXPECT_THAT(possible, testing::Contains("recovery_time"));
  EXPECT_THAT(possible, testing::Not(testing::Contains("clearance_min")));
}

TEST(CheckStudy, KnowsTheOutputsOfEveryPoint) {
  const TempFolder folder;
  const std::string box = "[{box: {x: 20, y: 3, length: 1, width: 1}}]";
  const CheckedStudy checked = CheckStudy(MakeStudy(folder,
                                                    "list:\n  - {drive.plants: [kinematic]}\n"
                                                    "  - {drive.plants: [mujoco], "
                                                    "world.obstacles: " +
                                                        box +
                                                        "}\n"
                                                        "outputs: [metrics.kinematic.time, "
                                                        "metrics.mujoco.clearance_min]\n"));
  EXPECT_EQ(checked.points.size(), 2U);
  EXPECT_EQ(checked.cars->compiled(), 1U);  // one model at one timestep
}

TEST(CheckStudy, AStudyOfPlantsNeedsOneColumnForEachResult) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(
      MakeStudy(folder,
                "vary: {drive.plants: [[kinematic], [single_track], [kinematic, single_track]]}\n"
                "outputs: [metrics.*.cross_track.max]\n"));
  for (std::size_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    const StudyPoint point = checked.points.Read(i);
    const Outputs outputs = DriveOnce(checked, point.scenario)->outputs;
    const std::string& plant = point.scenario.drive.plants.at(0);
    EXPECT_EQ(outputs.at("metrics.*.cross_track.max"),
              outputs.at("metrics." + plant + ".cross_track.max"));
  }
  // With two plants, the wildcard is ambiguous.
  const Outputs of_two = DriveOnce(checked, checked.points.Read(2).scenario)->outputs;
  EXPECT_EQ(of_two.count("metrics.*.cross_track.max"), 0U);
  EXPECT_EQ(of_two.count("metrics.single_track.cross_track.max"), 1U);
}

TEST(CheckStudy, TellsCarsOfDifferentSteeringRatesApart) {
  const TempFolder folder;
  const CheckedStudy checked =
      CheckStudy(MakeStudy(folder, "vary: {vehicle.steering_rate: [0.2, 0.3]}\n"));
  EXPECT_EQ(checked.cars->compiled(), 2U);
  std::set<double> rates;
  for (const StudyPoint& point : AllPoints(checked.points)) {
    rates.insert(checked.cars->Load(point.scenario)->params().steering_rate);
  }
  EXPECT_EQ(rates, (std::set<double>{0.2, 0.3}));
  EXPECT_EQ(checked.cars->compiled(), 2U);
}

TEST(CheckStudy, KnowsWhatAManeuverMeasures) {
  const TempFolder folder;
  const auto error = [&](const std::string& output) {
    return ErrorMessage(folder, [&] {
      CheckStudy(MakeStudy(
          folder, "set: {maneuver: {method: braking}}\nrepeat: 1\noutputs: [" + output + "]\n"));
    });
  };
  EXPECT_EQ(error("metrics.mujoco.maneuver.distance"), "no error");
  EXPECT_THAT(error("metrics.mujoco.maneuver.distanse"),
              testing::HasSubstr("did you mean 'metrics.mujoco.maneuver.distance'?"));
}

TEST(CheckStudy, CompilesEveryCarThatThereIs) {
  const TempFolder folder;
  folder.Write("broken.xml", "<mujoco><worldbody/></mujoco>\n");
  const std::string broken = (folder.path() / "broken.xml").string();
  EXPECT_THAT(ErrorMessage(folder,
                           [&] {
                             CheckStudy(MakeStudy(
                                 folder, "vary: {vehicle.model: [prius, '" + broken + "']}\n"));
                           }),
              testing::HasSubstr("broken.xml"));
}

/// The small car without the coefficients of its tyres.
std::string WithoutTyres() {
  const std::string text =
      ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/tests/data/models/small_car.xml");
  return std::regex_replace(text, std::regex("<numeric name=\"p_[^>]*/>"), "");
}

TEST(CheckStudy, NamesCarsThatLackWhatAPlantAsksOfThem) {
  const TempFolder folder;
  const std::string car = folder.Write("bare.xml", WithoutTyres()).string();
  const auto error = [&](const std::string& plant) {
    return ErrorMessage(folder, [&] {
      CheckStudy(MakeStudy(folder, "vary:\n  drive.plants: [[" + plant +
                                       "]]\n  vehicle.model: [prius, '" + car +
                                       "']\n  vehicle.tyre: [contact, magic_formula]\n"));
    });
  };
  EXPECT_EQ(error("mujoco"),
            "bare.xml: the model small_car has no tyre coefficients; tyre: magic_formula needs "
            "them in <custom>: p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under "
            "these names or of each with _front and _rear");
  EXPECT_EQ(error("mujoco:contact"), "no error");
  EXPECT_EQ(error("kinematic"), "no error");
}

/// A study whose runs take a tenth of a second each.
const std::string kShort = R"(set: {drive.plants: [kinematic], expect: {max_cross_track: 0.05}}
vary: {control.distance: [1, 2.5, 5]}
outputs: [metrics.kinematic.status, metrics.kinematic.cross_track.max, verdict.failures]
)";

/// The outputs without those that vary between runs (times).
Outputs Reproducible(Outputs outputs) {
  EXPECT_EQ(outputs.erase("timing.planning_s"), 1U);
  return outputs;
}

TEST(DriveOnce, ComesToWhatARunOfTheScenarioComesTo) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(MakeStudy(folder, kShort));
  for (const StudyPoint& point : AllPoints(checked.points)) {
    const std::optional<RunOutcome> outcome = DriveOnce(checked, point.scenario);
    ASSERT_TRUE(outcome.has_value());
    const RunResult run = RunScenario(point.scenario);
    EXPECT_EQ(outcome->passed, run.verdict.passed);
    EXPECT_EQ(outcome->status, run.verdict.passed ? "passed" : "failed");
    EXPECT_EQ(Reproducible(outcome->outputs), Reproducible(CollectOutputs(run)));
    const Outputs& outputs = outcome->outputs;
    EXPECT_EQ(outputs.at("metrics.kinematic.cross_track.max"),
              ShortestText(run.metrics[0].tracking->cross_track_max));
    EXPECT_EQ(outputs.at("metrics.kinematic.status"), "arrived");
    EXPECT_EQ(outputs.at("verdict.passed"), run.verdict.passed ? "true" : "false");
    EXPECT_EQ(outputs.at("verdict.robustness"),
              run.verdict.judged ? ShortestText(RobustnessOf(run).value) : "");
    EXPECT_EQ(outputs.at("plan.length_m"), ShortestText(run.plan->reference.path.length()));
    // Every output of a run was announced by PossibleOutputs.
    const std::vector<std::string> possible = PossibleOutputs(point.scenario);
    for (const auto& output : outputs) {
      EXPECT_THAT(possible, testing::Contains(output.first));
    }
  }
}

/// Keys of every section that affects the physics. The keys of the world come first: if a model
/// compiled for one of them were reused by mistake, the results of the later points would show it.
const std::string kEveryKind = R"(set: {drive.time_limit: 1, expect: {}}
list:
  - {world.ground.grade.x: 0.05}
  - {world.ground.grade.x: 0.0}
  - {world.ground.bumps: [{x: 4, y: 0, length: 2, width: 4}]}
  - {disturb.payload: {mass: 300}}
  - {world.friction: 0.05, mission.start.speed: 0.5}
  - {world.wind.x: -30}
  - {vehicle.tyre: contact}
  - {vehicle.model: bmw320i}
  - {drive.plants: [kinematic]}
  - {drive.plants: ["mujoco:magic_formula"]}
  - {drive.timestep: 0.004}
  - {mission.speed: 2, mission.start.speed: 0.5, plan.radius: 6}
outputs: [metrics.mujoco.distance]
)";

TEST(DriveOnce, DrivesEveryPointAsIfItWereAlone) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(MakeStudy(folder, kEveryKind));
  std::set<Outputs> different;
  for (const StudyPoint& point : AllPoints(checked.points)) {
    const std::optional<RunOutcome> outcome = DriveOnce(checked, point.scenario);
    EXPECT_EQ(Reproducible(outcome->outputs),
              Reproducible(CollectOutputs(RunScenario(point.scenario))))
        << point.settings[0].key;
    different.insert(Reproducible(outcome->outputs));
  }
  EXPECT_EQ(different.size(), checked.points.size());  // no two runs are mixed up
}

TEST(DriveOnce, DisturbsEveryPointInItsOwnWay) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(
      MakeStudy(folder,
                "set: {drive.plants: [mujoco], drive.time_limit: 3, mission.start.speed: 1}\n"
                "list:\n  - {disturb.kicks: [{at: 1, displacement: 0.2}]}\n"
                "  - {disturb.payload: {mass: 300}}\n  - {disturb.recovered_within: 1}\n"
                "outputs: [metrics.mujoco.recovery_time]\n"));
  EXPECT_EQ(checked.cars->compiled(), 1U);  // without payload
  std::set<std::string> distances;
  for (const StudyPoint& point : AllPoints(checked.points)) {
    const Outputs outputs = DriveOnce(checked, point.scenario)->outputs;
    EXPECT_EQ(Reproducible(outputs), Reproducible(CollectOutputs(RunScenario(point.scenario))));
    EXPECT_EQ(outputs.count("metrics.mujoco.recovery_time"), point.scenario.disturb.kicks.size());
    distances.insert(outputs.at("metrics.mujoco.distance"));
  }
  EXPECT_EQ(distances.size(), 3U);
  EXPECT_EQ(checked.cars->compiled(), 2U);
}

TEST(DriveOnce, TellsThatThereIsNoPlan) {
  const TempFolder folder;
  const CheckedStudy checked =
      CheckStudy(MakeStudy(folder, "list: [{mission.waypoints: [[0, 0], [10, 0], [10, 10]]}]\n"));
  const std::optional<RunOutcome> outcome = DriveOnce(checked, checked.points.Read(0).scenario);
  EXPECT_EQ(outcome->status, "no_plan");
  EXPECT_EQ(outcome->outputs.at("plan.status"), "turn_too_tight");
  EXPECT_EQ(outcome->outputs.count("plan.length_m"), 0U);
}

TEST(DriveOnce, EndsWithNothingWhenItIsInterrupted) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(MakeStudy(folder, kShort));
  EXPECT_FALSE(
      DriveOnce(checked, checked.points.Read(0).scenario, [] { return true; }).has_value());
}

TEST(DriveOnce, GivesTheSameSweepOnOneThreadAndOnFour) {
  const TempFolder folder;
  const CheckedStudy checked = CheckStudy(MakeStudy(folder, R"(set: {drive.time_limit: 3}
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
  const SweepResult one = RunSweep(checked.points, run, {.jobs = 1});
  const SweepResult four = RunSweep(checked.points, run, {.jobs = 4});
  EXPECT_EQ(one.table.ToCsv(), four.table.ToCsv());
  EXPECT_EQ(one.description.dump(), four.description.dump());
  // The rows differ, so that a mix-up would show.
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
                {"drive.timestep=0.004", "vehicle.tyre=contact"});
  // Keep three of the nine distances: 1, 2.5 and 5 m.
  std::vector<Setting>& distances = study.vary.at(0).alternatives;
  distances = {distances.at(0), distances.at(3), distances.at(6)};
  const CheckedStudy checked = CheckStudy(study);
  const SweepResult sweep =
      RunSweep(checked.points,
               [&](const Scenario& scenario) { return DriveOnce(checked, scenario); }, {.jobs = 2});
  const auto& rows = sweep.table.rows();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0][1], "passed");
  EXPECT_EQ(rows[1][1], "passed");
  EXPECT_EQ(rows[2][1], "failed");
  // With the preview distance L, the cross-track error e obeys e'' + 2/L e' + 2/L^2 e = f, to first
  // order. On the distance L before an arc of radius R, f grows as x^2/(L^2 R), where x is the
  // distance from the start of this stretch. On the arc, f vanishes. The error e therefore rises to
  // 0.104 L^2/R. This maximum is 0.57 L after the beginning of the arc. With a preview of 2.5 m the
  // car is back on the path before the arc of 16.83 m ends. Terms of higher order change this
  // maximum by (L/R)^2 = 2 %. Commands are held for 20 ms and the servo lags by 15 ms, together 4 %
  // of L. The tolerance of 10 % covers all of these effects.
  const double expected = 0.104 * 2.5 * 2.5 / 16.83;
  for (const std::size_t cross_track : {2U, 3U}) {  // on both plants
    EXPECT_NEAR(std::stod(rows[1][cross_track]), expected, Tolerance(0.1 * expected));
    EXPECT_GT(std::stod(rows[2][cross_track]), 0.15);
    // With a short preview, the steering rate is insufficient.
    EXPECT_GT(std::stod(rows[0][cross_track]), 2.0 * expected);
  }
}

}  // namespace
}  // namespace trackbed

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/cameras.h"

/// Tests the public functions LoadScenario, RunScenario, Find and Compare.
namespace trackbed {
namespace {

using testing::HasSubstr;

const char* const kCorner =
    "schema: 1\nname: corner\nmission: {speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}\n"
    "plan: {method: fillet}\ndrive: {plants: [kinematic, single_track]}\n";

std::string ErrorOf(const std::string& more) {
  const TempFolder folder;
  try {
    LoadScenario(folder.Write("corner.yaml", kCorner + more));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(LoadScenario, RefusesWhatTheProgramRefuses) {
  EXPECT_EQ(
      ErrorOf("expect: {metrics: [{metric: cross_track.max, max: 1}]}\nrender: {camera: side}\n"),
      "");
  EXPECT_THAT(ErrorOf("expect: {metrics: [{metric: cross_trak.max, max: 1}]}\n"),
              HasSubstr("did you mean 'cross_track.max'"));
  EXPECT_THAT(ErrorOf("render: {camera: chas}\n"), HasSubstr("did you mean 'chase'"));
}

TEST(RunScenario, HasThePlantsThatItSimulated) {
  const TempFolder folder;
  const RunResult run = RunScenario(folder.Write("corner.yaml", kCorner), {"mission.speed=2"});
  ASSERT_TRUE(run.plan.ok()) << run.plan->reason;
  const auto car = run.Find("kinematic");
  ASSERT_TRUE(car);
  EXPECT_EQ(&car->log, &run.logs[0]);
  EXPECT_EQ(&car->metrics, &run.metrics[0]);
  EXPECT_EQ(car->log.plant, "kinematic");
  EXPECT_FALSE(run.Find("mujoco"));
  EXPECT_EQ(run.scenario.mission.speed, 2.0);
}

TEST(Compare, IsThatOfTheRunsTable) {
  const TempFolder folder;
  const std::filesystem::path file = folder.Write("corner.yaml", kCorner);
  const RunResult run = RunScenario(file);
  const PlantComparison apart = Compare(run, "kinematic", "single_track");
  ASSERT_EQ(run.comparisons.size(), 1U);
  EXPECT_EQ(apart.position.max, run.comparisons[0].position.max);
  EXPECT_GT(apart.position.max, 0.0);
  const PlantComparison same = Compare(run, RunScenario(file), "kinematic");
  EXPECT_EQ(same.position.max, 0.0);
  EXPECT_EQ(same.first, "corner/kinematic");
  try {
    static_cast<void>(Compare(run, "kinematic", "mujoco"));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no plant mujoco; it has: kinematic, single_track"));
  }
}

/// The kinematic car with a constant error of its steering.
class CrookedPlant final : public Plant {
 public:
  CrookedPlant(std::unique_ptr<Plant> car, double error) : car_(std::move(car)), error_(error) {}
  void Step(const Command& command) override {
    Command crooked = command;
    crooked.steering += error_;
    car_->Step(crooked);
  }
  void ApplyLateralOffset(double left) override { car_->ApplyLateralOffset(left); }
  void ApplyLateralForce(double force) override { car_->ApplyLateralForce(force); }
  [[nodiscard]] VehicleState Observe() const override { return car_->Observe(); }
  [[nodiscard]] Pose2 pose() const override { return car_->pose(); }
  [[nodiscard]] std::vector<double> Configuration() const override { return car_->Configuration(); }
  [[nodiscard]] bool diverged() const override { return car_->diverged(); }

 private:
  std::unique_ptr<Plant> car_;
  double error_;  // [rad]
};

TEST(RunScenario, TakesPlantsFromFunctionsWithState) {
  const double error = 0.05;  // [rad]
  RegisterPlant({.name = "crooked",
                 .summary = "the kinematic car with a steering error",
                 .make = [error](const PlantSetup& setup) -> std::unique_ptr<Plant> {
                   return std::make_unique<CrookedPlant>(MakePlant("kinematic", setup), error);
                 }});
  const TempFolder folder;
  const RunResult run =
      RunScenario(folder.Write("corner.yaml", kCorner), {"drive.plants=[kinematic, crooked]"});
  EXPECT_GT(Compare(run, "kinematic", "crooked").position.max, 0.01);
}

RunResult RunBehind(double lead, const std::string& road) {
  return RunScenario(ParseScenario(
      fmt::format(
          "schema: 1\nname: behind\nvehicle: {{model: prius}}\n"
          "mission: {{speed: 8, waypoints: [[0, 0], [120, 0]], start: {{speed: 3}}}}\n"
          "world: {{obstacles: [{{box: {{x: 15, y: 0, length: 4, width: 1.8, height: 1.5}}, "
          "velocity: {{x: {}}}}}]}}\n"
          "plan: {{global: {{method: dubins}}, replan: {{road: {}, along: {{method: "
          "frenet}}}}}}\n"
          "drive: {{plants: [kinematic]}}\n",
          lead, road),
      "behind.yaml", ""));
}

TEST(FollowingNote, SaysHowLongAndWhy) {
  const RunResult result = RunBehind(3.0, "{left: 1.9, right: 1.9}");
  ASSERT_EQ(result.verdict.notes.size(), 1U);
  const std::string& note = result.verdict.notes.front();
  EXPECT_EQ(note.find("kinematic: followed a slower obstacle for "), 0U) << note;
  EXPECT_NE(note.find(" s instead of passing it: no room to pass"), std::string::npos) << note;
  // The car follows the leader for about 105 m at 3 m/s, until the leader is past the goal. The
  // last meters do not count, because the car brakes to its goal.
  const double time = std::stod(note.substr(note.find(" for ") + 5));
  EXPECT_GT(time, 25.0);
  EXPECT_LT(time, 40.0);
}

TEST(FollowingNote, IsAbsentWhereTheCarPassesAtOnce) {
  EXPECT_TRUE(RunBehind(2.0, "{left: 6, right: 6}").verdict.notes.empty());
}

// The car brakes behind an obstacle at 0.1 m/s. It can pull out only from a larger distance.
TEST(WaitingNote, SaysHowLongAndWhere) {
  const RunResult result = RunScenario(ParseScenario(
      "schema: 1\nname: waiting\nvehicle: {model: prius}\n"
      "mission: {speed: 6.4, waypoints: [[0, 0], [179, 0]], start: {speed: 4.4}}\n"
      "world: {obstacles: [{box: {x: 14.9, y: 0.35, length: 4.5, width: 1.8, height: 1.5}, "
      "velocity: {x: 0.1}, known_from: {range: 60}}]}\n"
      "plan: {global: {method: dubins}, replan: {along: {method: lattice}}}\n"
      "drive: {plants: [kinematic]}\n",
      "waiting.yaml", ""));
  ASSERT_EQ(result.verdict.notes.size(), 1U);
  const std::string& note = result.verdict.notes.front();
  ASSERT_EQ(note.find("kinematic: stood for "), 0U) << note;
  EXPECT_NE(note.find(": it stops"), std::string::npos) << note;
  double rest = 0.0;
  std::optional<double> station;
  const std::vector<LogRow>& rows = result.logs.front().rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (std::abs(rows[i].state.speed) < 1e-3 && rows[i].tracking->s < 170.0) {
      rest += rows[i].state.time - rows[i - 1].state.time;
      station = station.value_or(rows[i].tracking->s);
    }
  }
  EXPECT_GT(rest, 10.0);
  // The note has three digits; the control period is 0.02 s.
  EXPECT_NEAR(std::stod(note.substr(note.find(" for ") + 5)), rest, 0.005 * rest + 0.04);
  ASSERT_TRUE(station);
  EXPECT_NEAR(std::stod(note.substr(note.find("s = ") + 4)), *station, 0.01);
}

// Two boxes, 14 m wide, cross the road at 0.4 m/s, and the car waits before each of them.
TEST(WaitingNote, IsThereForEachPlace) {
  const RunResult result = RunScenario(ParseScenario(
      "schema: 1\nname: crossing\nvehicle: {model: prius}\n"
      "mission: {speed: 5, waypoints: [[0, 0], [160, 0]]}\n"
      "world: {obstacles: [{box: {x: 40, y: -4, length: 2, width: 14, height: 1.5}, "
      "velocity: {y: 0.4}, known_from: {range: 60}}, {box: {x: 120, y: -18, length: 2, width: 14, "
      "height: 1.5}, velocity: {y: 0.4}, known_from: {range: 60}}]}\n"
      "plan: {global: {method: dubins}, replan: {road: {left: 3, right: 3}, along: {method: "
      "lattice}}}\n"
      "drive: {plants: [kinematic]}\n",
      "crossing.yaml", ""));
  ASSERT_EQ(result.verdict.notes.size(), 2U);
  double rest_before[2] = {0.0, 0.0};
  const std::vector<LogRow>& rows = result.logs.front().rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double s = rows[i].tracking->s;
    if (std::abs(rows[i].state.speed) < 1e-3 && s > 1.0 && s < 150.0) {
      rest_before[s < 80.0 ? 0 : 1] += rows[i].state.time - rows[i - 1].state.time;
    }
  }
  for (const int place : {0, 1}) {
    const std::string& note = result.verdict.notes[static_cast<std::size_t>(place)];
    ASSERT_EQ(note.find("kinematic: stood for "), 0U) << note;
    // The note has three digits; the control period is 0.02 s.
    EXPECT_NEAR(std::stod(note.substr(note.find(" for ") + 5)), rest_before[place],
                0.005 * rest_before[place] + 0.04);
    // The front of the car is 3.6 m ahead of its rear axle.
    const double station = std::stod(note.substr(note.find("s = ") + 4));
    EXPECT_GT(station, place == 0 ? 30.0 : 110.0);
    EXPECT_LT(station, place == 0 ? 36.0 : 116.0);
  }
}

}  // namespace
}  // namespace trackbed

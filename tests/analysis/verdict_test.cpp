#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"

// Tests verdicts on whole runs with faults that earlier versions reported as arrived or passed.
namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

RunResult Drive(const std::string& yaml) {
  return RunScenario(ParseScenario("schema: 1\nname: verdict\n" + yaml, "verdict",
                                   TRACKBED_SOURCE_DIR "/tests/data/models"));
}

TEST(Verdict, FailsACarThatPassesThroughAThinWallBetweenTwoRows) {
  // At 10 m/s with a second between rows, no row's footprint touches the wall of 0.2 m.
  const RunResult run = Drive(
      "mission: {speed: 10, waypoints: [[0, 0], [100, 0], [200, 0]]}\n"
      "world: {obstacles: [{box: {x: 65, y: 0, length: 0.2, width: 3, height: 1}}]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic, mujoco], control_period: 1.0}\n");
  EXPECT_FALSE(run.verdict.passed);
  for (std::size_t i = 0; i < run.logs.size(); ++i) {
    SCOPED_TRACE(run.logs[i].plant);
    EXPECT_EQ(run.logs[i].status, DriveStatus::kCollided);
    EXPECT_EQ(run.metrics[i].clearance->min, 0.0);
    // The front bumper reaches the wall at the time (64.9 m - front)/(10 m/s). MuJoCo's car may be
    // a little slower.
    const LogRow& first = run.logs[i].rows.front();
    EXPECT_EQ(first.state.pose.x, 0.0);
    EXPECT_NEAR(*run.logs[i].contact_time, 6.13, 0.15);
  }
  // The contact force is recorded, too.
  EXPECT_GT(run.metrics[1].clearance->force_max, 1000.0);
}

TEST(Verdict, FailsACarThatAFastBoxPassesThrough) {
  // The box of 0.5 m moves 2.8 m between two rows.
  const RunResult run = Drive(
      "mission: {speed: 3, waypoints: [[0, 0], [50, 0], [100, 0]]}\n"
      "world: {obstacles: [{box: {x: 43.4, y: -390.5, length: 0.5, width: 0.5}, velocity: {y: "
      "28}}]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic], control_period: 0.1}\n");
  EXPECT_EQ(run.logs[0].status, DriveStatus::kCollided);
  EXPECT_NEAR(*run.logs[0].contact_time, 390.5 / 28.0, 0.1);
  EXPECT_FALSE(run.verdict.passed);
}

TEST(Verdict, MeasuresTheDistanceFromThePathBehindItsStart) {
  const RunResult run = Drive(
      "mission: {speed: 3, waypoints: [[0, 0], [30, 0], [60, 0]], start: {x: -20}}\n"
      "plan: {method: fillet, infeasible: allow}\ndrive: {plants: [kinematic]}\n");
  ASSERT_TRUE(run.plan.ok()) << run.plan->reason;
  EXPECT_NEAR(run.metrics[0].tracking->cross_track_max, 20.0, Tolerance(1e-9));
  EXPECT_EQ(run.logs[0].rows.front().tracking->s, 0.0);
  EXPECT_FALSE(run.verdict.passed);
  EXPECT_THAT(run.verdict.failures, Contains(HasSubstr("exceeds the car's width of ")));
}

TEST(Verdict, HoldsASmallCarToItsOwnSize) {
  // A car that steers a tenth of the commanded angle stops far from its goal at (2, 2).
  const std::string mission =
      "vehicle: {model: small_car.xml}\nmission: {speed: 1, waypoints: [[0, 0], [2, 0], [2, 2]]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic]}\n";
  const RunResult lost =
      Drive(mission + "control: {method: schedule}\ndisturb: {steering: {factor: 0.1}}\n");
  EXPECT_EQ(lost.logs[0].status, DriveStatus::kStopped);
  EXPECT_FALSE(lost.verdict.passed);
  const RunResult well = Drive(mission);
  EXPECT_EQ(well.logs[0].status, DriveStatus::kArrived);
  EXPECT_TRUE(well.verdict.passed);
}

TEST(Verdict, ArrivesWithinAShareOfTheCarsLength) {
  // In open loop, the car ends these turns beside the goal. The goal tolerance of the scenario
  // decides whether the car has arrived.
  const auto status = [](double tolerance) {
    return Drive(
        fmt::format("mission: {{speed: 3, waypoints: [[0, 0], [40, 0], [40, 40]]}}\n"
                    "plan: {{method: fillet}}\ncontrol: {{method: schedule}}\n"
                    "drive: {{plants: [kinematic], goal_tolerance: {}}}\n",
                    tolerance));
  };
  const RunResult run = status(1.0);
  const double length = LoadCar(run.scenario).params().length;
  const double share = run.metrics[0].tracking->goal_distance / length;
  EXPECT_GT(share, 1e-4);
  EXPECT_EQ(status(1.01 * share).logs[0].status, DriveStatus::kArrived);
  EXPECT_EQ(status(0.99 * share).logs[0].status, DriveStatus::kStopped);
}

TEST(Verdict, AsksForTheHeadingWhereTheMissionGivesOne) {
  const auto run = [](double tolerance) {
    return Drive(
        fmt::format("mission: {{speed: 3, waypoints: [[0, 0], [25, 15]], headings: [0, "
                    "1.5]}}\nplan: {{method: dubins}}\n"
                    "drive: {{plants: [kinematic], goal_heading_tolerance: {}}}\n",
                    tolerance));
  };
  const double error = std::abs(run(1.0).metrics[0].tracking->goal_heading_error);
  EXPECT_GT(error, 1e-6);
  EXPECT_EQ(run(1.01 * error).logs[0].status, DriveStatus::kArrived);
  EXPECT_EQ(run(0.99 * error).logs[0].status, DriveStatus::kStopped);
}

TEST(Verdict, IsNotPassedWhereNothingWasAsked) {
  const std::string drive =
      "mission: {speed: 3, duration: 1}\ncontrol: {method: constant_steering, steering: 0}\n"
      "drive: {plants: [kinematic]}\n";
  const RunResult run = Drive(drive);
  EXPECT_FALSE(run.verdict.judged);
  EXPECT_FALSE(run.verdict.passed);
  EXPECT_TRUE(ToJson(run.verdict)["passed"].is_null());
  EXPECT_TRUE(Drive(drive + "expect: {metrics: [{metric: time, max: 2}]}\n").verdict.passed);
}

TEST(Verdict, FailsACarThatIsFasterThanItsSpeedControlCorrects) {
  PlantMetrics metrics{.plant = "mujoco"};
  metrics.tracking.emplace();
  metrics.tracking->overspeed_limit = 1.56;
  metrics.tracking->overspeed_max = 1.55;
  EXPECT_THAT(Judge({}, {metrics}, {}).failures, testing::IsEmpty());
  metrics.tracking->overspeed_max = 2.4;
  const Verdict verdict = Judge({}, {metrics}, {});
  EXPECT_THAT(verdict.failures,
              ElementsAre(HasSubstr("2.4 m/s faster than planned, more than the 1.56 m/s")));
  EXPECT_THAT(verdict.notes, ElementsAre(HasSubstr("the car was 2.4 m/s faster than planned")));
  Expectations expect;
  expect.all.metrics = {{.metric = "overspeed_max", .min = {}, .max = 3.0, .equals = {}}};
  EXPECT_THAT(Judge(expect, {metrics}, {}).failures, testing::IsEmpty());
}

TEST(Verdict, FailsWheelsThatTurnFasterThanTheirActuator) {
  PlantMetrics metrics{.plant = "mujoco",
                       .steering_max = 0.3,
                       .steering_rate_max = 0.11,
                       .steering_rate_limit = 0.1,
                       .steering_limit = 0.25};
  EXPECT_THAT(Judge({}, {metrics}, {}).failures, Contains(HasSubstr("drive.timestep is too long")));
  // Prescribed wheels may exceed the limits: the run passes, with notes.
  metrics.steering_is_prescribed = true;
  const Verdict verdict = Judge({}, {metrics}, {});
  EXPECT_TRUE(verdict.failures.empty());
  EXPECT_THAT(
      verdict.notes,
      ElementsAre(
          "mujoco: the prescribed steering angle of 0.3 rad exceeds the vehicle limit of 0.25 rad",
          "mujoco: the prescribed steering rate of 0.11 rad/s exceeds the vehicle limit of 0.1 "
          "rad/s"));
}

TEST(Verdict, DoesNotBlameTheTimestepForWheelsInTheAir) {
  PlantMetrics metrics{.plant = "mujoco", .steering_rate_max = 0.422, .steering_rate_limit = 0.4};
  for (const DriveStatus status : {DriveStatus::kRolledOver, DriveStatus::kAirborne}) {
    metrics.status = status;
    EXPECT_THAT(
        Judge({}, {metrics}, {}).failures,
        ElementsAre(HasSubstr(std::string("did not complete the run: ") + ToString(status))));
  }
}

std::vector<std::string> CheckTexts(const Verdict& verdict) {
  std::vector<std::string> told;
  const nlohmann::ordered_json json = ToJson(verdict);
  for (const auto& check : json["checks"]) {
    told.push_back(check.dump());
  }
  return told;
}

TEST(Verdict, ListsEveryCheckWithBoundAndValueWhereAndWhen) {
  PlantMetrics metrics{.plant = "mujoco",
                       .time = 8.0,
                       .end_s = 20.0,
                       .steering_rate_max = 0.09,
                       .steering_rate_max_s = 3.0,
                       .steering_rate_max_t = 1.0,
                       .steering_rate_limit = 0.25};
  metrics.tracking = TrackingMetrics{.corridor = 2.0,
                                     .cross_track_rms = 0.25,
                                     .cross_track_max = 2.5,
                                     .cross_track_max_s = 6.0,
                                     .cross_track_max_t = 2.0};
  metrics.clearance = ClearanceMetrics{.min = 0.5, .min_s = 7.0, .min_t = 2.5};
  Expectations expect;
  expect.all.rms_cross_track = 0.5;
  expect.all.metrics = {{.metric = "maneuver.margin", .min = 0.0, .max = 1.0}};
  expect.between = {{{"mujoco", "kinematic"}, {.heading_max = 0.25}}};
  const PlantComparison between{.first = "kinematic",
                                .second = "mujoco",
                                .to_s = 20.0,
                                .heading = {.rms = 0.1, .max = 0.125, .max_s = 12.0, .max_t = 4.0}};
  const Verdict verdict = Judge(expect, {metrics}, {between});
  EXPECT_THAT(
      CheckTexts(verdict),
      ElementsAre(
          R"({"plant":"mujoco","metric":"status","relation":"equals","bound":"arrived",)"
          R"("value":"arrived","station":20.0,"time":8.0,"met":true})",
          R"({"plant":"mujoco","metric":"collision","relation":"equals","bound":false,)"
          R"("value":false,"station":7.0,"time":2.5,"met":true})",
          R"({"plant":"mujoco","metric":"steering_rate_max","relation":"at_most","bound":0.2575,)"
          R"("value":0.09,"station":3.0,"time":1.0,"met":true})",
          R"({"plant":"mujoco","metric":"cross_track.max","relation":"at_most","bound":2.0,)"
          R"("value":2.5,"station":6.0,"time":2.0,"met":false})",
          R"({"plant":"mujoco","metric":"maneuver.margin","relation":"at_least","bound":0.0,)"
          R"("value":null,"station":null,"time":null,"met":false})",
          R"({"plant":"mujoco","metric":"cross_track.rms","relation":"at_most","bound":0.5,)"
          R"("value":0.25,"station":null,"time":null,"met":true})",
          R"({"plant":"kinematic – mujoco","metric":"heading.max","relation":"at_most",)"
          R"("bound":0.25,"value":0.125,"station":12.0,"time":4.0,"met":true})"));
  EXPECT_EQ(verdict.failures.size(), 2U);
}

TEST(Verdict, SaysOnceThatACarHitAnObstacle) {
  PlantMetrics metrics{.plant = "mujoco", .status = DriveStatus::kCollided};
  metrics.clearance = ClearanceMetrics{.collision = true};
  const Verdict verdict = Judge({}, {metrics}, {});
  EXPECT_EQ(std::count_if(verdict.checks.begin(), verdict.checks.end(),
                          [](const Check& check) { return !check.met; }),
            2);
  EXPECT_THAT(verdict.failures, ElementsAre(HasSubstr("did not complete the run: collided")));
}

TEST(Verdict, PassesACoarseTimestepOnContacts) {
  const RunResult run = Drive(
      "vehicle: {tyre: contact}\n"
      "mission: {speed: 3, waypoints: [[0, 0], [40, 0], [40, 40]]}\nplan: {method: fillet}\n"
      "drive: {plants: [mujoco], timestep: 0.02, control_period: 0.1}\n");
  EXPECT_TRUE(run.verdict.passed);
  EXPECT_LE(run.metrics[0].steering_rate_max, 1.03 * run.metrics[0].steering_rate_limit);
}

// On a side slope, the wheels of a differential drive slip a little. Near standstill, the bicycle
// angle that their speeds give then jumps by more than 1 rad/s, the limit of the commands.
TEST(Verdict, JudgesNoSteeringRateWithoutSteeredWheels) {
  const RunResult run = Drive(
      "vehicle: {model: diff_drive}\nmission: {speed: 1, start: {speed: 0}}\nplan: {method: "
      "straight, length: 0.6}\n"
      "world: {ground: {grade: {x: 0.03, y: -0.1}}}\ndrive: {plants: [mujoco]}\n");
  EXPECT_GT(run.metrics[0].steering_rate_max, 1.0);
  EXPECT_TRUE(run.verdict.passed) << (run.verdict.failures.empty() ? "" : run.verdict.failures[0]);
}

TEST(Verdict, NotesThatContactsSlide) {
  const std::string braking =
      "mission: {speed: 20, duration: 2}\ncontrol: {method: constant_steering, steering: 0, speed: "
      "{braking: {at: 0.2, deceleration: 8.5}}}\ndrive: {plants: [mujoco]}\n";
  EXPECT_THAT(Drive("vehicle: {tyre: contact}\n" + braking).verdict.notes,
              Contains(HasSubstr("slid on MuJoCo contacts")));
  EXPECT_THAT(Drive(braking).verdict.notes, testing::IsEmpty());
}

TEST(Verdict, TellsOfSlowTurnsAndOfObstaclesOnThePath) {
  // A corner of 115 degrees after 28 m requires less than 4 m/s.
  const RunResult slow = Drive(
      "mission: {speed: 4, waypoints: [[0, 0], [28, 0], [16, 26]]}\nplan: {method: fillet}\n"
      "drive: {plants: [kinematic]}\n");
  EXPECT_THAT(slow.verdict.notes, Contains(HasSubstr("plan: speed reduced to")));
  const RunResult blocked = Drive(
      "mission: {speed: 3, waypoints: [[0, 0], [20, 0], [40, 0]]}\nplan: {method: fillet}\n"
      "world: {obstacles: [{box: {x: 30, y: 0, length: 2, width: 2}}]}\n"
      "drive: {plants: [kinematic]}\n");
  // The car's front is 3.625 m ahead of the rear axle, and the box begins at 29 m. The station at
  // which the plan hits the box has an error of up to 2 cm.
  EXPECT_THAT(blocked.verdict.notes,
              Contains(HasSubstr("plan: the path hits an obstacle at s = 25.3")));
}

TEST(Verdict, TellsOfAPlanThatWasSlowedDown) {
  const RunResult run = Drive(
      "mission: {speed: 4}\nplan: {method: lane_change, standard: iso_3888_2}\n"
      "drive: {plants: [kinematic]}\n");
  EXPECT_TRUE(run.verdict.passed);
  EXPECT_THAT(run.verdict.notes, Contains(HasSubstr("plan: speed reduced")));
  // The plan keeps within the car's steering rate, so the wheels never lag behind.
  EXPECT_LE(run.metrics[0].steering_rate_max, run.metrics[0].steering_rate_limit * (1.0 + 1e-6));
}

TEST(Verdict, RollingStartsOnBendsAreOnTheirPath) {
  // Each of these paths begins on a bend, while the car starts rolling with straight wheels.
  for (const char* mission : {"waypoints: [[0, 0], [25, 15]], headings: [0, 1.5]",
                              "waypoints: [[0, 0], [20, -15]], headings: [0, -2.5]",
                              "waypoints: [[0, 0], [-10, 20]], headings: [0.5, 3]",
                              "waypoints: [[0, 0], [5, 12]], headings: [-0.3, 1]"}) {
    for (const char* planner : {"dubins", "reeds_shepp", "hybrid_astar"}) {
      SCOPED_TRACE(std::string(planner) + " " + mission);
      const RunResult run =
          Drive(fmt::format("mission: {{speed: 3, {}}}\nplan: {{method: {}}}\n"
                            "drive: {{plants: [kinematic], time_limit: 150}}\n",
                            mission, planner));
      if (run.plan.ok()) {
        EXPECT_LE(run.metrics[0].tracking->cross_track_max, 0.6);
      } else {
        EXPECT_FALSE(run.verdict.passed);
      }
    }
  }
}

}  // namespace
}  // namespace trackbed

#include "trackbed/scenario/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <locale>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/playback.h"
#include "trackbed/control/recording_file.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"

namespace trackbed {
namespace scenario_test {

constexpr const char* kSmall = R"(schema: 1
name: small
mission:
  speed: 3
  waypoints: [[1, 2], [40, 2], [40, 40]]
plan: {method: fillet}
)";

Scenario Parse(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  return ParseScenario(yaml, "test.yaml", ".", overrides);
}

std::string ErrorMessages(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  return ErrorText([&] { Parse(yaml, overrides); });
}

TEST(ReadScenario, FillsInDefaults) {
  const Scenario scenario = Parse(kSmall);
  EXPECT_EQ(scenario.name, "small");
  EXPECT_EQ(scenario.vehicle.model, "prius");
  EXPECT_EQ(scenario.vehicle.tyre, TyreLaw::kAuto);
  EXPECT_EQ(scenario.mission.waypoints[1], Vec2(40, 2));
  ASSERT_TRUE(scenario.plan.has_value());
  EXPECT_STREQ(PlannerFor(scenario.plan->global).name, "fillet");
  EXPECT_STREQ(ControllerFor(scenario.control.steering).name, "preview");
  EXPECT_EQ(scenario.drive.plants, (std::vector<std::string>{"kinematic", "mujoco"}));
  EXPECT_EQ(scenario.world.friction, 1.0);
}

TEST(ReadScenario, StartsAtTheFirstWaypointAlongTheFirstLeg) {
  const StartState start =
      InitialState(Parse(kSmall, {"mission.waypoints=[[1, 2], [1, 40], [40, 40]]"}));
  EXPECT_EQ(start.pose.x, 1.0);
  EXPECT_EQ(start.pose.y, 2.0);
  EXPECT_EQ(start.pose.yaw, std::atan2(38.0, 0.0));
  EXPECT_EQ(start.speed, 3.0);
  const StartState moved =
      InitialState(Parse(kSmall, {"mission.start={x: 5, speed: 0, steering: 0.1}"}));
  EXPECT_EQ(moved.pose, (Pose2{5.0, 2.0, 0.0}));
  EXPECT_EQ(moved.speed, 0.0);
  EXPECT_EQ(moved.steering, 0.1);
}

TEST(ReadScenario, StartsWithTheSpeedThatIsGivenForThen) {
  const std::string braked =
      "schema: 1\nname: x\ncontrol: {method: sine, amplitude: 0.01, speed: {over_time: "
      "[[1, 20], [3, 5]]}}\nmission: ";
  EXPECT_EQ(InitialState(Parse(braked + "{duration: 5}")).speed, 20.0);
  EXPECT_EQ(MissionSpeed(Parse(braked + "{duration: 5}")), 20.0);
  EXPECT_EQ(InitialState(Parse(braked + "{speed: 7, duration: 5}")).speed, 20.0);
  EXPECT_EQ(MissionSpeed(Parse(braked + "{speed: 7, duration: 5}")), 7.0);
  EXPECT_EQ(InitialState(Parse(braked + "{start: {speed: 3}, duration: 5}")).speed, 3.0);
  const std::string held =
      "schema: 1\nname: x\ncontrol: {method: sine, amplitude: 0.01}\nmission: ";
  EXPECT_EQ(MissionSpeed(Parse(held + "{start: {speed: 3}, duration: 5}")), 3.0);
  EXPECT_EQ(ErrorMessages(held + "{duration: 5}"), "test.yaml:4:10: mission.speed: missing");
}

TEST(ReadScenario, TakesWhatTheMissionDoesNotSayFromTheRecording) {
  const TempFolder folder;
  folder.Write("inputs/r.csv",
               "t_s,s_m,steering_rad,speed_mps\n-1,0,0.2,10\n1,5,0.1,20\n4.5,9,0,5\n");
  const auto parse = [&](const std::vector<Override>& overrides) {
    return ParseScenario(
        "schema: 1\nname: x\nmission: {}\ncontrol: {method: playback, file: inputs/r.csv}\n",
        "test.yaml", folder.path(), overrides);
  };
  const Scenario scenario = parse({});
  EXPECT_EQ(RunDuration(scenario), 4.5);
  EXPECT_EQ(InitialState(scenario).speed, 15.0);
  EXPECT_EQ(MissionSpeed(scenario), 15.0);
  EXPECT_EQ(InitialState(scenario).steering, 0.0);
  const StartState prescribed = InitialState(parse({"drive.steering=prescribed"}));
  EXPECT_NEAR(prescribed.steering, 0.15, 1e-15);
  const Scenario given = parse({"drive.steering=prescribed",
                                "mission={speed: 3, duration: 2, start: {speed: 4, "
                                "steering: -0.1}}"});
  EXPECT_EQ(RunDuration(given), 2.0);
  EXPECT_EQ(InitialState(given).speed, 4.0);
  EXPECT_EQ(MissionSpeed(given), 3.0);
  EXPECT_EQ(InitialState(given).steering, -0.1);
  // A schedule over distance has no end time.
  EXPECT_EQ(RunDuration(parse({"control.by=distance", "mission.duration=3"})), 3.0);
  EXPECT_THROW(parse({"control.by=distance"}), InputError);
}

TEST(ReadScenario, ReportsEveryProblemWithItsPlace) {
  EXPECT_EQ(ErrorMessages(R"(schema: 1
name: broken
sed: 7
vehicle: {model: pruis, tyre: contakt}
mission:
  speed: -3
  waypoints: [[0, 0], [40], [40, .nan], here]
  sped: 3
plan: {method: fillet, radius: 0, constraint: halfleg, curvature: 3}
control: {method: previw}
drive: {plants: [kinematic, kinematic, mujocco], timestep: fast}
drive: {}
expect: {kinematik: {}, between: [{plants: kinematic}]}
)"),
            R"(test.yaml:3:1: sed: unknown key 'sed'; did you mean 'seed'?
test.yaml:4:18: vehicle.model: unknown model 'pruis'; did you mean 'prius'?
test.yaml:4:31: vehicle.tyre: unknown 'contakt'; did you mean 'contact'?
test.yaml:6:10: mission.speed: -3 is out of range; must be at least 0.1 and at most 100
test.yaml:7:23: mission.waypoints[1]: expected a point [x, y], found 1 number
test.yaml:7:34: mission.waypoints[2][1]: expected a finite number, found '.nan'
test.yaml:7:41: mission.waypoints[3]: expected a point [x, y], found 'here'
test.yaml:8:3: mission.sped: unknown key 'sped'; did you mean 'speed'?
test.yaml:9:32: plan.radius: 0 is out of range; must be above 0 and at most 100000
test.yaml:9:47: plan.constraint: unknown 'halfleg'; did you mean 'half_leg'?
test.yaml:9:56: plan.curvature: unknown key 'curvature'; allowed: method, radius, constraint, neutral_steering, max_radius, without_room, min_speed, objective, search, resimulate_each_turn, reference, weights, infeasible, max_waypoint_miss
test.yaml:10:19: control.method: unknown 'previw'; did you mean 'preview'?
test.yaml:11:29: drive.plants[1]: 'kinematic' is listed twice
test.yaml:11:40: drive.plants[2]: unknown 'mujocco'; did you mean 'mujoco'?
test.yaml:11:60: drive.timestep: expected a number, found 'fast'
test.yaml:12:1: drive: duplicate key
test.yaml:13:10: expect.kinematik: unknown key 'kinematik'; did you mean 'kinematic'?
test.yaml:13:35: expect.between[0]: no bound given; give position_max, heading_max, yaw_rate_max or steering_max
test.yaml:13:44: expect.between[0].plants: expected a list of names, found 'kinematic')");
}

TEST(ReadScenario, TakesAnyTurnOfADirection) {
  const auto heading = [](const std::string& yaw) {
    return Parse(kSmall, {"mission.start={yaw: " + yaw + "}"}).mission.start.yaw.value_or(99.0);
  };
  EXPECT_EQ(heading("3.1"), 3.1);
  EXPECT_EQ(heading("-3.141592653589793"), 3.141592653589793);  // the same direction
  // 7 rad is 7 - 2 pi after one turn; the reduction is exact to an ulp of 7.
  EXPECT_NEAR(heading("7"), 0.71681469282041377, Tolerance(1e-15));
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.start={yaw: 1e300}"}),
            "--set: mission.start.yaw: 1e+300 is out of range; must be at least -1000 and "
            "at most 1000");
}

TEST(ReadScenario, SaysHowToReplaceAllKeysOfAMethod) {
  const std::string yaml = std::string(kSmall) + "control: {method: preview, distance: 2}\n";
  EXPECT_EQ(ErrorMessages(yaml, {"control={method: lqr}"}), "");
  EXPECT_THAT(ErrorMessages(yaml, {"control.method=lqr"}),
              testing::EndsWith("; --set control.method keeps the other keys, --set "
                                "'control={method: lqr}' replaces them"));
}

TEST(ReadScenario, NamesMissingKeys) {
  EXPECT_EQ(ErrorMessages("name: x\nmission: {}\n"),
            "test.yaml:1:1: schema: missing\ntest.yaml:1:1: plan: missing; the controller preview "
            "needs a plan\ntest.yaml:2:10: mission.speed: missing\ntest.yaml:2:10: "
            "mission.duration: missing; required without a plan");
}

TEST(ReadScenario, RefusesWhatIsNoScenario) {
  EXPECT_EQ(ErrorMessages(""), "test.yaml:1:1: a scenario must be a section of 'key: value' lines");
  EXPECT_EQ(ErrorMessages("- 1\n- 2\n"),
            "test.yaml:1:1: a scenario must be a section of 'key: value' lines");
  EXPECT_EQ(ErrorMessages("a: [1, 2\nb: 3"),
            "test.yaml:1:4: '[' is not closed, or a ',' is missing before line 2, column 2");
  std::string bomb = "a: &a [1,1,1,1,1,1,1,1,1]\n";
  for (char c = 'b'; c < 'l'; ++c) {
    const std::string before(1, static_cast<char>(c - 1));
    bomb += std::string(1, c) + ": &" + c + " [*" + before;
    for (int i = 0; i < 8; ++i) {
      bomb += ",*" + before;
    }
    bomb += "]\n";
  }
  EXPECT_EQ(ErrorMessages(bomb), "test.yaml:6:8: more than 100000 values, aliases ('*') expanded");
  // A comment of a megabyte takes about a second.
  EXPECT_EQ(ErrorMessages("a: 1  # " + std::string(4'194'297, 'x')),
            "test.yaml: has 4194305 bytes of YAML; must be at most 4194304: keep long tables in "
            "CSV files that the YAML file names");
}

TEST(ReadScenario, RefusesKeysThatDoNotGoTogether) {
  EXPECT_EQ(ErrorMessages("schema: 1\nname: x\nmission: {speed: 3}\nplan: {method: fillet}\n"),
            "test.yaml:3:10: mission.waypoints: none given; the planner fillet needs at least 2");
  EXPECT_EQ(ErrorMessages("schema: 1\nname: x\nmission: {speed: 3}\n"),
            "test.yaml:1:1: plan: missing; the controller preview needs a plan\ntest.yaml:3:10: "
            "mission.duration: missing; required without a plan");
  EXPECT_EQ(ErrorMessages(kSmall, {"drive.control_period=0.003"}),
            "--set: drive.control_period: 0.003 s is not a whole number of timesteps of 0.002 s");
  EXPECT_EQ(ErrorMessages(kSmall, {"plan.constraint=none"}),
            "--set: plan.constraint: 'none' requires plan.radius");
  EXPECT_EQ(ErrorMessages(std::string(kSmall) + "drive: {plants: [mujoco]}\n",
                          {"expect={kinematic: {reach_goal: 1}}"}),
            "--set: expect.kinematic: not in drive.plants: mujoco");
}

TEST(ReadScenario, NamesAMissingFile) {
  try {
    ReadScenario("none.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "cannot read none.yaml: No such file or directory");
  }
}

TEST(Override, ReplacesAndAddsKeys) {
  const Scenario scenario = Parse(kSmall, {"mission.speed=2.5", "mission.waypoints[2]=[50, 60]",
                                           "control.method=schedule", "drive.timestep=0.001"});
  EXPECT_EQ(scenario.mission.speed, 2.5);
  EXPECT_EQ(scenario.mission.waypoints[2], Vec2(50, 60));
  EXPECT_STREQ(ControllerFor(scenario.control.steering).name, "schedule");
  EXPECT_EQ(scenario.drive.timestep, 0.001);
}

TEST(Override, OfThePlantsDropsWhatWasExpectedOfOthers) {
  const Scenario scenario =
      Parse(std::string(kSmall) +
                "expect: {mujoco: {reach_goal: 1}, kinematic: {reach_goal: 2}, "
                "between: [{plants: [kinematic, mujoco], position_max: 1}]}\n",
            {"drive.plants=[kinematic]"});
  ASSERT_EQ(scenario.expect.plants.size(), 1U);
  EXPECT_EQ(scenario.expect.plants[0].first, "kinematic");
  EXPECT_TRUE(scenario.expect.between.empty());
}

TEST(Override, SaysWhatIsWrong) {
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.speed"}), "--set: mission.speed: expected key=value");
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.sped=3"}),
            "--set: mission.sped: unknown key 'sped'; did you mean 'speed'?");
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.speed=-1"}),
            "--set: mission.speed: -1 is out of range; must be at least 0.1 and at most 100");
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.waypoints[9]=[1, 2]"}),
            "--set: mission.waypoints[9]=[1, 2]: element [9] does not exist");
  EXPECT_EQ(ErrorMessages(kSmall, {"name.first=x"}),
            "--set: name.first=x: no section for the key 'first'");
  EXPECT_EQ(ErrorMessages(kSmall, {"mission.waypoints=[[1, 2], [3, 4]"}),
            "--set: mission.waypoints=[[1, 2], [3, 4]: '[' is not closed");
  EXPECT_EQ(ErrorMessages(kSmall, {"name=c\xF6rner"}),
            "--set: name=c<0xF6>rner: byte 0xF6 is not valid UTF-8");
}

TEST(ResolvedYaml, ReadsBackToItself) {
  const Scenario scenario =
      Parse(kSmall, {"control.distance=2.345678901234567", "seed=18446744073709551615",
                     "control.method=preview",
                     "expect={reach_goal: 1, mujoco: {max_cross_track: 0.1}, between: [{plants: "
                     "[kinematic, mujoco], position_max: 0.3}]}"});
  const std::string once = ResolvedYaml(scenario);
  const std::string twice = ResolvedYaml(Parse(once));
  EXPECT_EQ(once, twice);
  EXPECT_THAT(once, testing::HasSubstr("2.345678901234567"));
  EXPECT_THAT(once, testing::HasSubstr("18446744073709551615"));
  EXPECT_THAT(once, testing::HasSubstr("control_period: 0.02"));
  EXPECT_THAT(once, testing::HasSubstr("max_cross_track: 0.1"));
}

TEST(ResolvedYaml, KeepsTheTimeLimitOfTrees) {
  const Scenario without = Parse(kSmall, {"plan={method: rrt}"});
  EXPECT_FALSE(without.plan->global.Get<RrtPlannerOptions>().time_limit.has_value());
  EXPECT_FALSE(without.plan->global.Get<RrtPlannerOptions>().partial.has_value());
  const std::string once =
      ResolvedYaml(Parse(kSmall, {"plan={method: rrt, time_limit: 0.25, partial: false}"}));
  const auto trees = Parse(once).plan->global.Get<RrtPlannerOptions>();
  EXPECT_EQ(trees.time_limit, 0.25);
  EXPECT_EQ(trees.partial, false);
  EXPECT_EQ(once, ResolvedYaml(Parse(once)));
}

TEST(ResolvedYaml, KeepsManeuversAndWhatIsAskedOfThem) {
  const std::string once = ResolvedYaml(
      Parse(kSmall, {"vehicle.steering_rate=0.25", "maneuver={method: step_steer, steady: 0.5}",
                     "expect.metrics=[{metric: maneuver.tb, min: 0.125, max: 2}, "
                     "{metric: maneuver.passed, equals: true}]"}));
  const Scenario scenario = Parse(once);
  EXPECT_EQ(once, ResolvedYaml(scenario));
  EXPECT_EQ(scenario.vehicle.steering_rate, 0.25);
  ASSERT_TRUE(scenario.maneuver.has_value());
  EXPECT_EQ(std::get<StepSteerOptions>(*scenario.maneuver).steady, 0.5);
  const auto& metrics = scenario.expect.all.metrics;
  ASSERT_EQ(metrics.size(), 2U);
  EXPECT_EQ(metrics[0].metric, "maneuver.tb");
  EXPECT_EQ(metrics[0].min, 0.125);
  EXPECT_EQ(metrics[0].max, 2.0);
  EXPECT_FALSE(metrics[0].equals.has_value());
  EXPECT_EQ(metrics[1].equals, "true");
}

constexpr const char* kWorld = R"(world:
  friction: 0.8
  friction_patches:
    - {x: 10, y: 1, yaw: 0.5, length: 20, width: 3, friction: 0.1}
    - {x: 12, y: 1, length: 2, width: 3, friction: 0.6}
  ground:
    grade: {x: 0.05, y: -0.02}
    bumps: [{x: 15, y: 0, length: 4, width: 6, height: 0.08, edge: 0.4}]
    side_slopes: [{x: 50, y: 0, yaw: 1.5, length: 40, width: 8, slope: -0.06, transition_length: 12}]
  wind:
    x: 1.5
    y: -2
    gusts:
      - {y: 12, from: 3, duration: 2}
      - {x: 4, shape: step, area: {x: 20, y: 0, yaw: 0.1, length: 30, width: 10}}
)";

void ExpectWorld(const World& world) {
  EXPECT_EQ(world.friction, 0.8);
  ASSERT_EQ(world.friction_patches.size(), 2U);
  EXPECT_EQ(world.friction_patches[0].area.center, (Pose2{10.0, 1.0, 0.5}));
  EXPECT_EQ(world.friction_patches[0].area.length, 20.0);
  EXPECT_EQ(world.friction_patches[0].area.width, 3.0);
  EXPECT_EQ(world.friction_patches[0].friction, 0.1);
  EXPECT_EQ(world.friction_patches[1].friction, 0.6);
  EXPECT_EQ(world.ground.grade, Vec2(0.05, -0.02));
  ASSERT_EQ(world.ground.bumps.size(), 1U);
  EXPECT_EQ(world.ground.bumps[0].area.length, 4.0);
  EXPECT_EQ(world.ground.bumps[0].height, 0.08);
  EXPECT_EQ(world.ground.bumps[0].edge, 0.4);
  ASSERT_EQ(world.ground.side_slopes.size(), 1U);
  EXPECT_EQ(world.ground.side_slopes[0].area.center, (Pose2{50.0, 0.0, 1.5}));
  EXPECT_EQ(world.ground.side_slopes[0].slope, -0.06);
  EXPECT_EQ(world.ground.side_slopes[0].transition_length, 12.0);
  EXPECT_EQ(world.wind.velocity, Vec2(1.5, -2.0));
  ASSERT_EQ(world.wind.gusts.size(), 2U);
  EXPECT_EQ(world.wind.gusts[0].velocity, Vec2(0.0, 12.0));
  EXPECT_EQ(world.wind.gusts[0].from, 3.0);
  EXPECT_EQ(world.wind.gusts[0].duration, 2.0);
  EXPECT_EQ(world.wind.gusts[0].shape, GustShape::kOneMinusCosine);
  EXPECT_FALSE(world.wind.gusts[0].area.has_value());
  EXPECT_EQ(world.wind.gusts[1].from, 0.0);
  EXPECT_FALSE(world.wind.gusts[1].duration.has_value());
  EXPECT_EQ(world.wind.gusts[1].shape, GustShape::kStep);
  ASSERT_TRUE(world.wind.gusts[1].area.has_value());
  EXPECT_EQ(world.wind.gusts[1].area->center, (Pose2{20.0, 0.0, 0.1}));
  EXPECT_EQ(world.wind.gusts[1].area->width, 10.0);
}

TEST(ReadScenario, ReadsTheWorldAndWritesItBack) {
  const Scenario scenario = Parse(std::string(kSmall) + kWorld);
  ExpectWorld(scenario.world);
  const std::string once = ResolvedYaml(scenario);
  ExpectWorld(Parse(once).world);
  EXPECT_EQ(once, ResolvedYaml(Parse(once)));
}

TEST(ReadWorld, ReadsThatSectionAlone) {
  const TempFolder folder;
  ExpectWorld(ReadWorld(folder.Write("a.yaml", std::string("vehicle: {model: gone}\n") + kWorld)));
  EXPECT_TRUE(IsFlat(ReadWorld(folder.Write("b.yaml", "schema: 1\n")).ground));
  EXPECT_THROW(ReadWorld(folder.Write("c.yaml", "world: {wind: {z: 1}}\n")), InputError);
}

TEST(ReadExpectations, ReadsThatSectionAlone) {
  const TempFolder folder;
  const Expectations expect = ReadExpectations(folder.Write(
      "a.yaml",
      "vehicle: {model: gone}\nexpect: {reach_goal: 0.5, mujoco: {max_cross_track: 0.1}, "
      "between: [{plants: [kinematic, mujoco], position_max: 0.3}]}\n"));
  EXPECT_EQ(expect.all.reach_goal, 0.5);
  ASSERT_EQ(expect.plants.size(), 1U);
  EXPECT_EQ(expect.plants[0].first, "mujoco");
  EXPECT_EQ(expect.plants[0].second.max_cross_track, 0.1);
  ASSERT_EQ(expect.between.size(), 1U);
  EXPECT_EQ(expect.between[0].bounds.position_max, 0.3);
  EXPECT_FALSE(ReadExpectations(folder.Write("b.yaml", "schema: 1\n")).all.reach_goal);
  EXPECT_THROW(ReadExpectations(folder.Write("c.yaml", "expect: {reach: 1}\n")), InputError);
}

TEST(ResolvedYaml, KeepsManeuvers) {
  const std::string once = ResolvedYaml(
      Parse("schema: 1\nname: x\nmission: {duration: 5}\n"
            "control: {method: step, amplitude: 0.1, rate: 0.4, speed: {over_time: [[0, 20], [2, "
            "5.5]], braking: {at: 3, deceleration: 8}}}\n"));
  EXPECT_EQ(once, ResolvedYaml(Parse(once)));
  for (const char* text : {"rate: 0.4", "over_time: [[0, 20], [2, 5.5]]", "deceleration: 8"}) {
    EXPECT_THAT(once, testing::HasSubstr(text));
  }
}

TEST(ResolvedYaml, HasTheCopyOfAModelGivenByPathBesideIt) {
  const TempFolder folder;
  folder.Write("car.xml", "<mujoco/>");
  folder.Write("cars/car.xml", "<mujoco/>");
  for (const char* model : {"cars/car.xml", "car.xml", "./car.xml"}) {
    const Scenario scenario =
        ParseScenario(kSmall, "test.yaml", folder.path(), {"vehicle.model=" + std::string(model)});
    EXPECT_THAT(ResolvedYaml(scenario), testing::HasSubstr("model: vehicle.xml\n")) << model;
  }
}

TEST(ResolvedYaml, HasItsRecordingBesideIt) {
  const TempFolder folder;
  folder.Write("inputs/r.csv", "time,steering_rad,speed_mps\n0,0,9\n2,0.1,9\n");
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: x\nmission: {}\ncontrol: {method: playback, file: inputs/../inputs/r.csv, "
      "columns: {time: time}}\n",
      "test.yaml", folder.path());
  const std::string once = ResolvedYaml(scenario);
  EXPECT_THAT(once, testing::HasSubstr("file: recording.csv\n"));
  EXPECT_THAT(once, testing::HasSubstr("duration: 2\n"));
  EXPECT_THAT(once, testing::HasSubstr("speed: 9\n"));
  const TempFolder elsewhere;
  elsewhere.Write("recording.csv", RecordingCsv(*FindRecording(scenario), PlaybackAxis::kTime));
  EXPECT_EQ(once, ResolvedYaml(ParseScenario(once, "resolved.yaml", elsewhere.path())));
}

TEST(PlaybackLaneChange, IsOnePeriodOfASine) {
  const Recording recording =
      ReadRecording(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/playback_lane_change.csv",
                    PlaybackAxis::kTime);
  const SineSteeringOptions sine{.amplitude = 0.04, .frequency = 0.4, .cycles = 1.0, .at = 1.0};
  ASSERT_EQ(recording.steering.knots.size(), 501U);
  for (const Vec2& knot : recording.steering.knots) {
    EXPECT_NEAR(knot.y(), SteeringAt(sine, knot.x()), 0.500001e-6);  // six decimals
    EXPECT_EQ(recording.speed.At(knot.x()), 15.0);
  }
}

TEST(ParseScenario, AsksForMetricsThatARunCanHave) {
  const auto told = [](const std::string& metric) -> std::string {
    try {
      ParseScenario(
          "schema: 1\nname: s\nmission: {duration: 1, speed: 3}\n"
          "control: {method: constant_steering, steering: 0.1}\n"
          "expect:\n  mujoco: {metrics: [{metric: \"" +
              metric + "\", max: 1}]}\n",
          "s.yaml", ".", {}, [](const Scenario& scenario) {
            EXPECT_EQ(scenario.name, "s");
            return std::vector<std::string>{"time", "turns[0].at", "turns[1].at"};
          });
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(told("time"), "none");
  EXPECT_EQ(told("turns[1].at"), "none");
  EXPECT_EQ(told("tine"),
            "s.yaml:6:31: expect.mujoco.metrics[0].metric: unknown metric 'tine'; did you mean "
            "'time'?");
  EXPECT_EQ(told("distance"),
            "s.yaml:6:31: expect.mujoco.metrics[0].metric: unknown metric 'distance'; allowed: "
            "time, turns[0].at");
}

/// As in German: a decimal comma and a dot between thousands.
class GermanNumbers : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ReadScenario, ReadsNumbersAlikeInAnyLocale) {
  const std::locale german(std::locale::classic(), new GermanNumbers);
  const std::locale before = std::locale::global(german);
  const double speed = Parse(kSmall, {"mission.speed=1.500"}).mission.speed;
  std::locale::global(before);
  EXPECT_EQ(speed, 1.5);
}

class ScenarioFiles : public testing::TestWithParam<std::filesystem::path> {};

std::vector<std::filesystem::path> AllScenarioFiles() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"/scenarios", "/scenarios/maneuvers"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(TRACKBED_SOURCE_DIR) + folder)) {
      if (entry.path().extension() == ".yaml") {
        files.push_back(entry.path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Files, ScenarioFiles, testing::ValuesIn(AllScenarioFiles()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST_P(ScenarioFiles, CanBeReadAndIsNamedAfterItsFile) {
  EXPECT_EQ(ReadScenario(GetParam()).name, GetParam().stem().string());
}

}  // namespace scenario_test
}  // namespace trackbed

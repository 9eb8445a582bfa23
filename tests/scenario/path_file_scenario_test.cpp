#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A path on a circle of 20 m radius from (3, 4), with points 1 m apart.
std::string Circle() {
  std::string text = "east,north,v_kmh\n";
  for (int i = 0; i < 40; ++i) {
    text += fmt::format("{},{},{}\n", 3.0 + 20.0 * std::sin(0.05 * i),
                        4.0 + 20.0 * (1.0 - std::cos(0.05 * i)), i < 20 ? 10.8 : 7.2);
  }
  return text;
}

std::string Text(const std::string& plan) {
  return "schema: 1\nname: x\nmission: {speed: 4}\nplan: {method: path_file, " + plan + "}\n";
}

constexpr const char* kCircle = "file: p.csv, columns: {x: east, y: north}";

Scenario Parse(const TempFolder& folder, const std::string& plan,
               const std::vector<Override>& overrides = {}) {
  return ParseScenario(Text(plan), "test.yaml", folder.path(), overrides);
}

std::string Error(const TempFolder& folder, const std::string& plan) {
  return ErrorText([&] { Parse(folder, plan); });
}

TEST(PathFileScenario, StartsOnThePath) {
  const TempFolder folder;
  folder.Write("p.csv", Circle());
  const Scenario scenario = Parse(folder, kCircle);
  const StartState start = InitialState(scenario, ReferenceCar());
  // The spline deviates from the points by at most 0.05 m.
  EXPECT_NEAR(start.pose.x, 3.0, Tolerance(0.05));
  EXPECT_NEAR(start.pose.y, 4.0, Tolerance(0.05));
  EXPECT_EQ(start.speed, 4.0);
  const auto& path = scenario.plan->global.Get<PathFileOptions>().path->path;
  EXPECT_EQ(start.steering, SteeringForCurvature(ReferenceCar(), path.At(0.0).curvature));
  // The steering angle is atan(2.7/20) = 0.134 rad. A deviation of the path by 0.05 m may change
  // this angle a little.
  EXPECT_NEAR(start.steering, 0.134, Tolerance(0.03));
  EXPECT_EQ(
      InitialState(Parse(folder, kCircle, {"mission.start.steering=0.1"}), ReferenceCar()).steering,
      0.1);
  EXPECT_NEAR(InitialState(Parse(folder, std::string(kCircle) + ", speeds: file")).speed, 3.0,
              Tolerance(1e-14));
  EXPECT_EQ(InitialState(
                Parse(folder, std::string(kCircle) + ", speeds: file", {"mission.start.speed=1"}))
                .speed,
            1.0);
}

TEST(PathFileScenario, StartsNoFasterThanTheMission) {
  const TempFolder folder;
  folder.Write("p.csv", Circle());  // 3 m/s at first
  const auto start_speed = [&](const std::vector<Override>& overrides) {
    return InitialState(Parse(folder, std::string(kCircle) + ", speeds: file", overrides)).speed;
  };
  EXPECT_NEAR(start_speed({"mission.speed=4"}), 3.0, Tolerance(1e-14));
  EXPECT_EQ(start_speed({"mission.speed=2"}), 2.0);
  EXPECT_EQ(start_speed({"mission.speed=2", "mission.start.speed=5"}), 5.0);
}

TEST(PathFileScenario, RefusesSpeedsThatCannotBeDriven) {
  const TempFolder folder;
  const auto error = [&](const std::string& csv, const std::string& keys) {
    folder.Write("v.csv", csv);
    return Error(folder, "file: v.csv, speeds: " + keys);
  };
  const std::string zeros = "x,y,v\n0,0,2\n10,0,0\n20,0,0\n30,0,2\n";
  EXPECT_THAT(error(zeros, "file"),
              AllOf(HasSubstr("v.csv:3: speed: the speed is 0 from point 2 to point 3, 10 m along "
                              "the path"),
                    HasSubstr("speeds: mission")));
  EXPECT_EQ(error(zeros, "mission"), "");
  EXPECT_EQ(error("x,y,v\n0,0,0\n10,0,2\n20,0,0\n30,0,2\n40,0,0\n", "file"), "");
  // The car stands, and its measured position jitters by less than max_deviation.
  EXPECT_EQ(error("x,y,v\n0,0,0\n0.01,0,0\n10,0,2\n20,0,2\n", "file"), "");
  EXPECT_THAT(error("x,y\n0,0\n10,0\n", "file"), HasSubstr("columns.speed"));
  EXPECT_THAT(error("x,y,v\n0,0,1\n10,0,-101\n20,0,-102\n", "file"),
              AllOf(HasSubstr("v.csv:3: v: -101 is out of range"),
                    HasSubstr("and 1 more invalid cells in this column")));
  EXPECT_EQ(error("x,y,v\n0,0,1\n10,0,-101\n20,0,-102\n", "mission"), "");
  const std::string waits = "t,x,y\n0,0,0\n1,3,0\n2,6,0\n7,6,0\n8,9,0\n9,12,0\n";
  EXPECT_EQ(error(waits, "file"), "");
  EXPECT_EQ(error(waits, "mission"), "");
}

TEST(PathFileScenario, HasItsPointsBesideIt) {
  const TempFolder folder;
  folder.Write("p.csv", Circle());
  const Scenario scenario = Parse(folder, std::string(kCircle) + ", ahead: 1.4, speeds: file");
  const std::string once = ResolvedYaml(scenario);
  EXPECT_THAT(once, AllOf(HasSubstr("file: path.csv\n"), HasSubstr("ahead: 0\n"),
                          HasSubstr("CSV, columns east, north, v_kmh")));
  const TempFolder elsewhere;
  const FittedPath& fitted = *scenario.plan->global.Get<PathFileOptions>().path;
  elsewhere.Write(kPathCsv, PathCsv(fitted.given));
  const Scenario again = ParseScenario(once, "resolved.yaml", elsewhere.path());
  EXPECT_EQ(once, ResolvedYaml(again));
  EXPECT_EQ(again.plan->global.Get<PathFileOptions>().path->path.segments(),
            fitted.path.segments());
}

/// A three-point turn: 4 m to the left, 3 m back to the right, 5 m ahead.
Path ThreePointTurn() {
  return Path({1.0, 2.0, 0.3}, {{.length = 4.0, .curvature = 0.15},
                                {.length = 3.0, .curvature = -0.15, .direction = -1},
                                {.length = 5.0, .curvature = 0.1}});
}

/// Columns x, y and the speed, which is negative in reverse and 0 at the cusps.
std::string SignedSpeeds(const Path& path) {
  std::string text = "x,y,v\n";
  for (const Stations& leg : SplitIntoLegs(path)) {
    for (int i = leg.from == 0.0 ? 0 : 1; i <= 10; ++i) {
      const PathPoint at = path.At(std::lerp(leg.from, leg.to, 0.1 * i) - (i == 10 ? 1e-12 : 0.0));
      text += fmt::format("{},{},{}\n", at.pose.x, at.pose.y, i == 10 ? 0.0 : at.direction * 0.8);
    }
  }
  return text;
}

TEST(PathFileScenario, KeepsReversePiecesInItsRunFolder) {
  const TempFolder folder;
  folder.Write("v.csv", SignedSpeeds(ThreePointTurn()));
  const Scenario scenario = Parse(folder, "file: v.csv, speeds: file");
  const FittedPath& fitted = *scenario.plan->global.Get<PathFileOptions>().path;
  EXPECT_EQ(SplitIntoLegs(fitted.path).size(), 3U);
  const TempFolder elsewhere;
  elsewhere.Write(kPathCsv, PathCsv(fitted.given));
  const Scenario again = ParseScenario(ResolvedYaml(scenario), "resolved.yaml", elsewhere.path());
  EXPECT_EQ(again.plan->global.Get<PathFileOptions>().path->path.segments(),
            fitted.path.segments());
}

TEST(PathFileScenario, StartsInReverseAtRest) {
  const TempFolder folder;
  folder.Write("back.csv", "x,y,v\n0,0,-1\n-5,0,-1\n-10,0,-1\n");
  for (const std::string speeds : {"file", "mission"}) {
    const Scenario scenario = Parse(folder, "file: back.csv, speeds: " + speeds);
    EXPECT_EQ(InitialState(scenario).speed, 0.0);
    EXPECT_NEAR(InitialState(scenario).pose.yaw, 0.0, Tolerance(1e-12));
  }
}

TEST(PathFileScenario, PlansNoDetoursInReverse) {
  const TempFolder folder;
  folder.Write("v.csv", SignedSpeeds(ThreePointTurn()));
  try {
    ParseScenario(
        "schema: 1\nname: x\nmission: {speed: 4}\nplan:\n  global: {method: path_file, file: "
        "v.csv}\n  replan: {along: {method: frenet}}\n",
        "test.yaml", folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("not available for plans by path_file, which may reverse"));
  }
}

TEST(PathFileScenario, ReadsFilesBelowItsFolderAlone) {
  const TempFolder folder;
  folder.Write("p.csv", Circle());
  folder.Write("inner/p.csv", Circle());
  EXPECT_EQ(Error(folder, "file: inner/p.csv, columns: {x: east, y: north}"), "");
  folder.Write("scenarios/x", "");
  const Scenario allowed =
      ParseScenario(Text("file: ../p.csv, columns: {x: east, y: north}"), "test.yaml",
                    folder.path() / "scenarios", {}, {}, {folder.path()});
  EXPECT_NE(allowed.plan->global.Get<PathFileOptions>().path, nullptr);
  try {
    ParseScenario(Text("file: ../p.csv"), "test.yaml", folder.path() / "scenarios");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("test.yaml:4"), HasSubstr("plan.file: ../p.csv")));
  }
}

TEST(PathFileScenario, SaysWhatIsWrong) {
  const TempFolder folder;
  folder.Write("p.csv", Circle());
  folder.Write("unknown.csv", "along,across\n0,0\n1,0\n");
  folder.Write("cell.csv", "x,y\n0,0\n1,one\n");
  folder.Write("point.csv", "x,y\n0,0\n0,0\n");
  folder.Write("back.csv", "x,y,yaw,gear\n0,0,3.1,D\n1,0,3.1,D\n2,0,3.1,D\n");
  EXPECT_THAT(Error(folder, "file: unknown.csv"),
              AllOf(HasSubstr("unknown.csv:1"), HasSubstr("no column for x")));
  EXPECT_THAT(Error(folder, "file: cell.csv"), HasSubstr("cell.csv:3: y: 'one'"));
  EXPECT_THAT(Error(folder, "file: point.csv"), HasSubstr("1 different point; must be at least 2"));
  EXPECT_THAT(Error(folder, "file: back.csv"), HasSubstr("heading of point 1"));
  EXPECT_THAT(Error(folder, "file: none.csv"), HasSubstr("none.csv"));
  EXPECT_THAT(Error(folder, "fit: spline"), HasSubstr("plan.file: missing"));
  EXPECT_THAT(Error(folder, std::string(kCircle) + ", fit: cubic"), HasSubstr("plan.fit"));
  EXPECT_THAT(Error(folder, std::string(kCircle) + ", max_deviation: 0"),
              HasSubstr("plan.max_deviation"));
  EXPECT_THAT(Error(folder, std::string(kCircle) + ", resample: 0.001, fit: polyline"), "");
  EXPECT_THAT(Error(folder, "file: p.csv, columns: {x: east, y: north, yaw_unit: grad}"),
              HasSubstr("plan.columns.yaw_unit: unknown unit 'grad'"));
  EXPECT_THAT(Error(folder, std::string(kCircle) + ", origin_latitude: 3"),
              HasSubstr("plan.origin_longitude"));
}

}  // namespace
}  // namespace trackbed

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/track/track_file.h"

// Tests the local origin of scenarios with large coordinates. All coordinates of the random
// scenarios are multiples of 1/8 m, so moving them by whole meters is exact.
namespace trackbed {
namespace local_origin_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Vec2 kFar(500000.0, 5200000.0);

/// Random coordinates around a place.
class Places {
 public:
  Places(unsigned seed, const Vec2& offset) : random_(seed), offset_(offset) {}

  std::string X() { return fmt::format("{}", Number() + offset_.x()); }
  std::string Y() { return fmt::format("{}", Number() + offset_.y()); }
  std::string Box() { return fmt::format("x: {}, y: {}, length: 3, width: 2", X(), Y()); }
  std::string Point() {
    const std::string x = X();
    return fmt::format("[{}, {}]", x, Y());
  }

 private:
  double Number() { return std::uniform_int_distribution<int>(-1600, 1600)(random_) / 8.0; }

  std::mt19937 random_;
  Vec2 offset_;
};

/// A scenario with every kind of place that keys have. The start is given in every second one.
std::string Everything(unsigned seed, const Vec2& offset) {
  Places at(seed, offset);
  std::string text = "schema: 1\nname: far\n";
  text += "mission:\n  speed: 5\n  waypoints: [" + at.Point() + ", " + at.Point() + ", " +
          at.Point() + "]\n";
  if (seed % 2 == 0) {
    text += "  start: {x: " + at.X() + ", y: " + at.Y() + "}\n";
  }
  text += "world:\n  friction_patches:\n    - {" + at.Box() + ", friction: 0.5}\n";
  text += "  ground:\n    bumps:\n      - {" + at.Box() + "}\n";
  text += "    side_slopes:\n      - {" + at.Box() + ", slope: 0.1}\n";
  text += "  wind:\n    gusts:\n      - {y: 5, duration: 1, area: {" + at.Box() + "}}\n";
  text += "  obstacles:\n    - box: {" + at.Box() + "}\n    - box: {" + at.Box() + "}\n";
  return text + "plan: {method: dubins, infeasible: allow}\n";
}

Scenario Parse(const std::string& text, const std::filesystem::path& folder = "") {
  return ParseScenario(text, "test.yaml", folder);
}

TEST(LocalOrigin, MovesEveryKindOfPlace) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Scenario here = Parse(Everything(seed, Vec2::Zero()));
    Scenario there = Parse(Everything(seed, kFar));
    EXPECT_FALSE(here.origin.has_value());
    // All places are within 200 m of the offset, which is a multiple of the step of origins.
    ASSERT_TRUE(there.origin.has_value());
    EXPECT_EQ(*there.origin, kFar);
    there.origin.reset();
    EXPECT_EQ(ResolvedYaml(there), ResolvedYaml(here)) << "seed " << seed;
  }
}

TEST(LocalOrigin, IsStatedInTheResolvedScenario) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Scenario there = Parse(Everything(seed, kFar));
    const std::string resolved = ResolvedYaml(there);
    EXPECT_THAT(resolved, HasSubstr("origin: [500000, 5200000]"));
    const Scenario again = Parse(resolved);
    EXPECT_EQ(ResolvedYaml(again), resolved);
    EXPECT_EQ(again.mission.waypoints, there.mission.waypoints);
    EXPECT_EQ(InitialState(again).pose, InitialState(there).pose);
  }
}

TEST(LocalOrigin, IsTheOneThatTheUserGives) {
  const std::string text =
      "schema: 1\nname: x\nmission: {speed: 5, waypoints: [[500010, 5200020], [500060, 5200020]]}\n"
      "plan: {method: dubins}\n";
  EXPECT_EQ(Parse(text).origin, Vec2(500000.0, 5200000.0));
  const Scenario given = Parse(text + "origin: [500010, 5200000]\n");
  EXPECT_EQ(given.mission.waypoints.front(), Vec2(0.0, 20.0));
  EXPECT_EQ(given.mission.waypoints.back(), Vec2(50.0, 20.0));
  // An origin may be given for small coordinates, too. A start that is (0, 0) by default was not
  // moved.
  const Scenario near = Parse(
      "schema: 1\nname: x\norigin: [10, 20]\nmission: {speed: 5, duration: 1}\ncontrol: "
      "{method: constant_steering, steering: 0}\n");
  EXPECT_EQ(InitialState(near).pose.position(), Vec2(-10.0, -20.0));
  const auto error = [&](const std::string& more) {
    return ErrorText([&] { Parse(text + more); });
  };
  EXPECT_THAT(error("origin: [0.5, 1]\n"), HasSubstr("origin: must be two whole numbers [x, y]"));
  EXPECT_THAT(error("origin: [500000]\n"), HasSubstr("origin: must be two whole numbers [x, y]"));
  EXPECT_THAT(error("origin: [0, 0]\n"),
              AllOf(HasSubstr("mission.waypoints[0] is at (500010.00, 5200020.00), 5.2e+06 m from "
                              "the origin (0.00, 0.00)"),
                    HasSubstr("set another origin")));
}

TEST(LocalOrigin, RefusesPlacesInDifferentCoordinates) {
  const TempFolder folder;
  std::string points = "x_m,y_m\n";
  for (int i = 0; i < 20; ++i) {
    points += fmt::format("{},5200000\n", 500000 + i);
  }
  folder.Write("utm.csv", points);
  const auto error = [&](const std::string& more) {
    return ErrorText([&] {
      Parse("schema: 1\nname: x\nmission: {speed: 5}\n" + more +
                "plan: {method: path_file, file: utm.csv}\n",
            folder.path());
    });
  };
  EXPECT_EQ(error(""), "");
  EXPECT_THAT(
      error("world: {obstacles: [{box: {x: 3, y: 4, length: 1, width: 1}}]}\n"),
      AllOf(HasSubstr("world.obstacles[0].box"), HasSubstr("is at (3.00, 4.00)"),
            HasSubstr(
                "the file of the planner path_file is at (500009.50, 5200000.00), 5.2e+06 m away"),
            HasSubstr("give both in the same coordinates")));
  // Obstacles far from a car that starts at (0, 0) by default.
  EXPECT_THAT(ErrorText([] {
                Parse(
                    "schema: 1\nname: x\nmission: {speed: 5, duration: 1}\ncontrol: "
                    "{method: constant_steering, steering: 0}\nworld: {obstacles: "
                    "[{box: {x: 500000, y: 4, length: 1, width: 1}}]}\n");
              }),
              AllOf(HasSubstr("mission.start"), HasSubstr("the start of the car is at (0.00, "
                                                          "0.00)")));
}

TEST(LocalOrigin, GivesBackTheContentsOfFiles) {
  const TempFolder folder;
  std::vector<TrackPoint> ring = RingPoints(40.0, 50, 4.0, 3.0);
  for (TrackPoint& point : ring) {
    point.position += kFar;
  }
  folder.Write("ring.csv", TrackCsv(ring));
  std::string points = "x_m,y_m\n";
  for (int i = 0; i < 40; ++i) {
    points += fmt::format("{:.3f},{:.3f}\n", 500000.0 + 20.0 * std::sin(0.05 * i),
                          5200000.0 - 20.0 * std::cos(0.05 * i));
  }
  folder.Write("path.csv", points);
  folder.Write("map.pgm", "P5\n2 2\n255\n" + std::string(4, '\xfe'));
  folder.Write("map.yaml",
               "image: map.pgm\nresolution: 0.5\norigin: [500000.125, 5200000.25, 0.5]\nnegate: 0\n"
               "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const std::string world = "world: {map: {file: map.yaml}}\n";
  for (const std::string& own :
       {std::string("mission: {speed: 5}\nplan: {method: path_file, file: path.csv}\n"),
        std::string(
            "mission: {speed: 5, track: {file: ring.csv}}\nplan: {method: center_line}\n")}) {
    const Scenario first = Parse("schema: 1\nname: x\n" + world + own, folder.path());
    ASSERT_TRUE(first.origin.has_value());
    EXPECT_LT((InitialState(first).pose.position()).norm(), 1000.0);
    EXPECT_EQ(first.world.map->data->map().X_WM, (Pose2{0.125, 0.25, 0.5}));
    const std::string resolved = ResolvedYaml(first);
    for (const InputFile& file : InputFiles(first)) {
      folder.Write("run/" + file.name, file.content);
    }
    const Scenario again = Parse(resolved, folder.path() / "run");
    EXPECT_EQ(ResolvedYaml(again), resolved);
    EXPECT_EQ(InitialState(again).pose, InitialState(first).pose);
    const std::vector<InputFile> before = InputFiles(first);
    const std::vector<InputFile> after = InputFiles(again);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(after[i].content, before[i].content) << before[i].name;
    }
    // Videos and reports read the world from the run folder.
    folder.Write("run/scenario.resolved.yaml", resolved);
    EXPECT_EQ(ReadWorld(folder.path() / "run/scenario.resolved.yaml").map->data->map().X_WM,
              (Pose2{0.125, 0.25, 0.5}));
  }
}

/// A straight road of 100 m along x from a place in the file, with an offset in the header.
std::string RoadFrom(const Vec2& start, const Vec2& offset) {
  RoadText road;
  road.geometry =
      fmt::format("<geometry s=\"0\" x=\"{}\" y=\"{}\" hdg=\"0\" length=\"100\"><line/></geometry>",
                  start.x(), start.y());
  road.heights =
      "<elevationProfile><elevation s=\"0\" a=\"0\" b=\"0.05\" c=\"0\" "
      "d=\"0\"/></elevationProfile>";
  std::string text = Document(road.Xml());
  const std::string header = "<header revMajor=\"1\" revMinor=\"6\"/>";
  return text.replace(
      text.find(header), header.size(),
      fmt::format("<header revMajor=\"1\" revMinor=\"6\"><offset x=\"{}\" y=\"{}\" z=\"0\" "
                  "hdg=\"0\"/></header>",
                  offset.x(), offset.y()));
}

TEST(LocalOrigin, MovesRoadsWithTheirHeights) {
  const TempFolder folder;
  folder.Write("near.xodr", RoadFrom({0.0, 0.0}, {0.0, 0.0}));
  folder.Write("far.xodr", RoadFrom(kFar, {0.0, 0.0}));
  folder.Write("offset.xodr", RoadFrom({0.0, 0.0}, kFar));
  const auto read = [&](const std::string& file, const std::string& more) {
    return Parse("schema: 1\nname: x\nworld: {road_network: " + file + more +
                     "}\nmission: {speed: 5, route: [{road: 1, lane: -1, s: 20}, {road: 1, lane: "
                     "-1, s: 80}]}\nplan: {method: lane_route}\n",
                 folder.path());
  };
  const Scenario near = read("near.xodr", "");
  const std::string obstacle = ", obstacles: [{box: {x: 500050, y: 5200030, length: 1, width: 1}}]";
  for (const Scenario& far :
       {read("far.xodr", ""), read("far.xodr", obstacle), read("offset.xodr", obstacle)}) {
    EXPECT_EQ(far.origin, kFar);
    EXPECT_EQ(InitialState(far).pose, InitialState(near).pose);
    for (double x = 0.0; x <= 100.0; x += 5.0) {
      // Both computations use the same arithmetic with the same coordinates.
      EXPECT_NEAR(GroundHeight(far.world, {x, -1.75}), GroundHeight(near.world, {x, -1.75}),
                  Tolerance(1e-9));
    }
  }
  // Without other places, the coordinates of the file are those of the scenario.
  EXPECT_FALSE(read("offset.xodr", "").origin.has_value());
  EXPECT_THAT(ErrorText([&] { read("near.xodr", obstacle); }),
              HasSubstr("the route on near.xodr is at (50.00, -1.75)"));
}

TEST(LocalOrigin, IsAddedToThePositionsOfItsTables) {
  const TempFolder folder;
  folder.Write("plan.csv",
               "x_m,y_m,origin_x_m,origin_y_m\n0,0,500000,5200000\n1,0,500000,5200000\n"
               "2,0,500000,5200000\n");
  const Scenario scenario =
      Parse("schema: 1\nname: x\nmission: {speed: 5}\nplan: {method: path_file, file: plan.csv}\n",
            folder.path());
  EXPECT_EQ(scenario.origin, kFar);
  EXPECT_EQ(scenario.plan->global.Get<PathFileOptions>().path->given.points.front(),
            Vec2(0.0, 0.0));
}

}  // namespace local_origin_test
}  // namespace trackbed

#include "trackbed/path_files/commonroad_scenario.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/path_files/formats.h"
#include "tests/support/error_text.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::string Point(double x, double y) {
  return fmt::format("<point><x>{}</x><y>{}</y></point>", x, y);
}

/// A straight lanelet, 4 m wide, from (x, y) to (x + length, y), with further XML elements.
std::string StraightLanelet(int id, const Vec2& from, double length, const std::string& more) {
  return fmt::format(
      "<lanelet id=\"{}\"><leftBound>{}{}</leftBound><rightBound>{}{}</rightBound>{}</lanelet>\n",
      id, Point(from.x(), from.y() + 2.0), Point(from.x() + length, from.y() + 2.0),
      Point(from.x(), from.y() - 2.0), Point(from.x() + length, from.y() - 2.0), more);
}

std::string State(const char* tag, const Pose2& pose, int step, double speed) {
  return fmt::format(
      "<{0}><position>{1}</position><orientation><exact>{2}</exact></orientation>"
      "<time><exact>{3}</exact></time><velocity><exact>{4}</exact></velocity></{0}>\n",
      tag, Point(pose.x, pose.y), pose.yaw, step, speed);
}

std::string Rectangle(const Vec2& center, double length, double width) {
  return fmt::format(
      "<rectangle><length>{}</length><width>{}</width>"
      "<center><x>{}</x><y>{}</y></center></rectangle>",
      length, width, center.x(), center.y());
}

std::string PlanningProblem(const Pose2& start, double speed, const std::string& goal, int from,
                            int to) {
  return fmt::format(
      "<planningProblem id=\"9\">{}<goalState>{}<time><intervalStart>{}"
      "</intervalStart><intervalEnd>{}</intervalEnd></time></goalState>"
      "</planningProblem>\n",
      State("initialState", start, 0, speed),
      goal.empty() ? "" : "<position>" + goal + "</position>", from, to);
}

std::string Document(const std::string& content) {
  return "<commonRoad timeStepSize=\"0.1\" benchmarkID=\"Z\">\n" + content + "</commonRoad>\n";
}

/// Two adjacent lanes of 100 m, and the next 100 m of both lanes.
std::string Roads() {
  return StraightLanelet(1, {0.0, 0.0}, 100.0,
                         "<successor ref=\"3\"/><adjacentLeft ref=\"2\" drivingDir=\"same\"/>") +
         StraightLanelet(2, {0.0, 4.0}, 100.0, "<successor ref=\"4\"/>") +
         StraightLanelet(3, {100.0, 0.0}, 100.0, "") + StraightLanelet(4, {100.0, 4.0}, 100.0, "");
}

CommonRoadScenario Read(const std::string& content) {
  return ReadCommonRoadScenario("z.xml", Document(content));
}

std::string Refusal(const std::string& content) {
  return ErrorText([&] { Read(content); });
}

/// Returns the y coordinate of the route at x.
double HeightAt(const CommonRoadScenario& scenario, double x) {
  for (std::size_t i = 1; i < scenario.route.size(); ++i) {
    const Vec2& from = scenario.route[i - 1];
    const Vec2& to = scenario.route[i];
    if (from.x() <= x && x <= to.x()) {
      return from.y() + (x - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
    }
  }
  return std::nan("");
}

TEST(CommonRoadScenario, LeadsFromTheStartOntoTheCenterOfTheLane) {
  const CommonRoadScenario scenario =
      Read(Roads() + PlanningProblem({5.0, 0.8, 0.05}, 10.0, "<lanelet ref=\"3\"/>", 100, 150));
  EXPECT_EQ(scenario.name, "Z");
  EXPECT_EQ(scenario.route.front(), Vec2(5.0, 0.8));
  const Vec2 first = scenario.route[1] - scenario.route[0];
  // The quintic polynomial has the slope tan(0.05) at the start. Over its first meter, the slope
  // changes by less than 1.5 u (10 d_0/L) = 1.5/16 x 0.5, with u = 1/L. The lateral motion by d_0 =
  // 0.8 m has a length L of at least 16 m at 10 m/s.
  EXPECT_NEAR(first.y() / first.x(), std::tan(0.05), Tolerance(0.05));
  // The length of the lateral motion is v sqrt(5.77 d_0/a) = 10 sqrt(5.77 x 0.8/1.5) = 17.5 m.
  EXPECT_NEAR(HeightAt(scenario, 5.0 + 18.5), 0.0, Tolerance(1e-9));
  EXPECT_NEAR(HeightAt(scenario, 150.0), 0.0, Tolerance(1e-9));
}

TEST(CommonRoadScenario, TheRearAxleBeginsBehindTheInitialState) {
  for (const Pose2& start : {Pose2{10.0, 0.0, 0.0}, Pose2{10.0, 0.8, 0.3}, Pose2{10.0, -1.5, -0.6},
                             Pose2{10.0, 0.5, -0.9}}) {
    const std::string problem =
        PlanningProblem(start, 10.0, Rectangle({150.0, 0.0}, 40.0, 4.0), 100, 200);
    const PathPoints points = ReadCommonRoad("z.xml", Document(Roads() + problem)).points;
    ASSERT_EQ(points.yaw.size(), points.points.size());
    const PathPoints rear = AtRearAxle(points, kCommonRoadCenterAhead);
    const Vec2 expected =
        start.position() - kCommonRoadCenterAhead * Vec2(std::cos(start.yaw), std::sin(start.yaw));
    EXPECT_LE((rear.points.front() - expected).norm(), Tolerance(1e-12)) << start.yaw;
    // The rear axle does not slip: the chord of its path, an arc of a tractrix, has the mean
    // heading up to the cube of the turn.
    for (std::size_t i = 1; i < rear.points.size(); ++i) {
      const Vec2 step = rear.points[i] - rear.points[i - 1];
      const double turn = AngleDifference(rear.yaw[i], rear.yaw[i - 1]);
      const double mean = rear.yaw[i - 1] + 0.5 * turn;
      EXPECT_LE(std::abs(AngleDifference(std::atan2(step.y(), step.x()), mean)),
                std::abs(turn) * 0.2 + Tolerance(1e-9))
          << i;
    }
  }
}

TEST(CommonRoadScenario, KeepsTheSpeedIfTheCarArrivesInTime) {
  // The goal lanelet is 95 m to 195 m ahead. At 10 m/s, the car is in the goal lanelet from 9.5 s
  // to 19.5 s.
  const auto speed = [](int from, int to) {
    return Read(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", from, to))
        .speed;
  };
  EXPECT_EQ(speed(100, 150), 10.0);
  // Within 6 s, the car must drive 95 m and the margin of 2 m. With the acceleration a = 2.5 m/s^2
  // to the speed v, the car drives v t - (v - v_0)^2/(2 a) in the time t. This is 95.5 m for v =
  // 18.1 m/s, 96.8 m for 18.6 m/s, and 97.06 m for 18.7 m/s.
  EXPECT_NEAR(speed(0, 60), 18.7, Tolerance(0.1 + 1e-9));
  // After 30 s, the car must have driven at most 195 m less the margin of 2 m: v t + (v - v_0)^2/(2
  // a) <= 193 m, which is true for v = 6.36 m/s.
  EXPECT_NEAR(speed(300, 310), 6.36, Tolerance(0.1));
}

TEST(CommonRoadScenario, ChangesLanesOnlyWhereItMust) {
  const CommonRoadScenario straight =
      Read(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 100, 150));
  const CommonRoadScenario change =
      Read(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"4\"/>", 100, 150));
  EXPECT_NEAR(HeightAt(straight, 99.0), 0.0, Tolerance(1e-9));
  // The length of a lane change by 4 m is 10 sqrt(5.77 x 4/1.5) = 39.2 m.
  EXPECT_NEAR(HeightAt(change, 5.0 + 20.0), 2.0, Tolerance(0.2));
  EXPECT_NEAR(HeightAt(change, 5.0 + 41.0), 4.0, Tolerance(1e-9));
}

TEST(CommonRoadScenario, PassesThroughASmallGoalBesideTheCenter) {
  const CommonRoadScenario scenario =
      Read(Roads() +
           PlanningProblem({5.0, 0.0, 0.0}, 10.0, Rectangle({150.0, 1.5}, 2.0, 0.5), 100, 200));
  EXPECT_NEAR(HeightAt(scenario, 150.0), 1.5, Tolerance(0.01));
  EXPECT_NEAR(HeightAt(scenario, 100.0), 0.0, Tolerance(1e-9));
  EXPECT_TRUE(scenario.goal.regions.front().Contains({150.9, 1.7}));
  EXPECT_FALSE(scenario.goal.regions.front().Contains({151.1, 1.5}));
}

// The middle of the goal is on the edge of the lane at y = -2, or beside it. The route passes
// through the goal's middle, as through goals on the lane. A disc of 1 m about (150, -3.5) ends at
// y = -2.5.
TEST(CommonRoadScenario, PassesThroughAGoalOnTheEdgeOfTheLane) {
  for (const double y : {-2.0, -2.5}) {
    const CommonRoadScenario scenario = Read(
        Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, Rectangle({150.0, y}, 2.0, 2.0), 0, 300));
    EXPECT_NEAR(HeightAt(scenario, 150.0), y, Tolerance(1e-6));
  }
  // The middle is on the end of the last lanelet.
  EXPECT_NEAR(HeightAt(Read(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0,
                                                      Rectangle({200.0, 0.0}, 2.0, 2.0), 0, 300)),
                       199.5),
              0.0, Tolerance(1e-6));
  EXPECT_THAT(Refusal(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0,
                                                Rectangle({150.0, -3.5}, 2.0, 2.0), 0, 300)),
              HasSubstr("the goal's region is in no lanelet"));
}

TEST(CommonRoadScenario, AGoalWithAPlaceNeedsNoTime) {
  const std::string start = State("initialState", {5.0, 0.0, 0.0}, 0, 10.0);
  const auto problem = [&](const std::string& goal) {
    return "<planningProblem id=\"9\">" + start + "<goalState>" + goal +
           "</goalState></planningProblem>\n";
  };
  const std::string place = "<position><lanelet ref=\"3\"/></position>";
  const CommonRoadScenario any = Read(Roads() + problem(place));
  EXPECT_EQ(any.goal.time.first, 0.0);
  EXPECT_FALSE(std::isfinite(any.goal.time.second));
  EXPECT_EQ(any.speed, 10.0);
  EXPECT_THAT(any.notes, Contains(HasSubstr("at any time")));
  // Some files give a time step that no car reaches instead.
  const CommonRoadScenario late =
      Read(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 0, 100000000));
  EXPECT_EQ(late.goal.time.second, 1e7);
  EXPECT_EQ(late.route, any.route);
  EXPECT_THAT(Refusal(Roads() + problem("")), HasSubstr("neither a position nor a time"));
}

TEST(CommonRoadScenario, ReadsMotions) {
  const std::string obstacle =
      "<dynamicObstacle id=\"7\"><shape><rectangle><length>4</length><width>2</width></rectangle>"
      "</shape>" +
      State("initialState", {20.0, 4.0, 0.0}, 0, 5.0) + "<trajectory>" +
      State("state", {20.5, 4.0, 0.1}, 1, 5.0) + State("state", {21.0, 4.1, 0.2}, 2, 5.0) +
      "</trajectory></dynamicObstacle>";
  const CommonRoadScenario scenario =
      Read(Roads() + obstacle + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "", 0, 50));
  ASSERT_EQ(scenario.obstacles.size(), 1U);
  EXPECT_EQ(scenario.obstacles[0].box.length, 4.0);
  EXPECT_THAT(scenario.obstacles[0].poses, ElementsAre(std::pair(0.0, Pose2{20.0, 4.0, 0.0}),
                                                       std::pair(0.1, Pose2{20.5, 4.0, 0.1}),
                                                       std::pair(0.2, Pose2{21.0, 4.1, 0.2})));
}

// Scenarios that were converted from OpenSCENARIO have the recorded car among their obstacles.
TEST(CommonRoadScenario, LeavesOutTheRecordedCar) {
  const auto moving = [](double x, double yaw) {
    return "<dynamicObstacle id=\"7\"><shape><rectangle><length>4</length><width>2</width>"
           "</rectangle></shape>" +
           State("initialState", {x, 0.0, yaw}, 0, 10.0) + "<trajectory>" +
           State("state", {x + 1.0, 0.0, yaw}, 1, 10.0) + "</trajectory></dynamicObstacle>";
  };
  const CommonRoadScenario scenario = Read(Roads() + moving(5.0, 2.0 * kPi) + moving(25.0, 0.0) +
                                           PlanningProblem({5.0, 0.0, 0.0}, 10.0, "", 0, 50));
  ASSERT_EQ(scenario.obstacles.size(), 1U);
  EXPECT_EQ(scenario.obstacles[0].poses.front().second.x, 25.0);
  EXPECT_THAT(scenario.notes, Contains(HasSubstr("it is the recorded car")));
}

// A recorded car that waits has states, but does not move.
TEST(CommonRoadScenario, LeavesOutTheRecordedCarThatStands) {
  const auto waiting = [](double x) {
    return "<dynamicObstacle id=\"7\"><shape><rectangle><length>4</length><width>2</width>"
           "</rectangle></shape>" +
           State("initialState", {x, 0.0, 0.0}, 0, 0.0) + "<trajectory>" +
           State("state", {x, 0.0, 0.0}, 1, 0.0) + "</trajectory></dynamicObstacle>";
  };
  const CommonRoadScenario scenario = Read(Roads() + waiting(5.0) + waiting(25.0) +
                                           PlanningProblem({5.0, 0.0, 0.0}, 0.0, "", 0, 50));
  ASSERT_EQ(scenario.obstacles.size(), 1U);
  EXPECT_EQ(scenario.obstacles[0].box.center.x, 25.0);
  EXPECT_THAT(scenario.notes, Contains(HasSubstr("it is the recorded car")));
}

TEST(CommonRoadScenario, EnclosesShapesByBoxes) {
  // The obstacles are a square that is rotated by 45 degrees, and a disc.
  const auto standing = [](const std::string& shape) {
    return "<staticObstacle id=\"7\"><shape>" + shape + "</shape>" +
           State("initialState", {20.0, 4.0, 0.5 * kPi}, 0, 0.0) + "</staticObstacle>";
  };
  const CommonRoadScenario scenario =
      Read(Roads() +
           standing("<polygon>" + Point(1.0, 0.0) + Point(0.0, 1.0) + Point(-1.0, 0.0) +
                    Point(0.0, -1.0) + "</polygon>") +
           standing("<circle><radius>1.5</radius><center><x>1</x><y>0</y></center></circle>") +
           PlanningProblem({5.0, 0.0, 0.0}, 10.0, "", 0, 50));
  ASSERT_EQ(scenario.obstacles.size(), 2U);
  const OrientedBox& square = scenario.obstacles[0].box;
  EXPECT_NEAR(square.length, std::sqrt(2.0), Tolerance(1e-12));
  EXPECT_NEAR(square.width, std::sqrt(2.0), Tolerance(1e-12));
  EXPECT_NEAR(square.center.x, 20.0, Tolerance(1e-12));
  // The center of the disc is 1 m ahead of the obstacle, which heads north.
  const OrientedBox& disc = scenario.obstacles[1].box;
  EXPECT_EQ(disc.length, 3.0);
  EXPECT_NEAR(disc.center.x, 20.0, Tolerance(1e-12));
  EXPECT_NEAR(disc.center.y, 5.0, Tolerance(1e-12));
  EXPECT_THAT(scenario.notes, testing::Contains(HasSubstr("1 obstacles are discs or polygons")));
}

// A car whose place is known at first, and then within boxes that grow and turn. The smallest box
// of each place may be described with any of its sides as the length.
TEST(CommonRoadScenario, CoversOccupanciesByBoxesThatSpreadOut) {
  const std::vector<OrientedBox> places{{{20.0, 4.0, 0.0}, 4.0, 2.0},
                                        {{26.0, 4.0, 0.1}, 9.0, 2.0},
                                        {{31.0, 4.5, 0.2}, 14.0, 5.0},
                                        {{36.0, 5.0, 0.3}, 18.0, 3.0}};
  std::string set;
  for (std::size_t step = 1; step < places.size(); ++step) {
    const auto corners = places[step].Corners();
    std::string polygon;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2& corner = corners[(i + step) % corners.size()];
      polygon += Point(corner.x(), corner.y());
    }
    set += fmt::format(
        "<occupancy><shape><polygon>{}</polygon></shape><time><exact>{}</exact></time>"
        "</occupancy>",
        polygon, step);
  }
  const CommonRoadScenario scenario =
      Read(Roads() +
           "<dynamicObstacle id=\"7\"><shape><rectangle><length>4</length><width>2</width>"
           "</rectangle></shape>" +
           State("initialState", places[0].center, 0, 60.0) + "<occupancySet>" + set +
           "</occupancySet></dynamicObstacle>" + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "", 0, 50));
  // 18 m of 4 m, and 5 m of 2 m.
  ASSERT_EQ(scenario.obstacles.size(), 5U * 3U);
  EXPECT_THAT(scenario.notes, Contains(HasSubstr("1 obstacles are sets of occupied places: 15")));
  for (std::size_t step = 0; step < places.size(); ++step) {
    std::vector<OrientedBox> pieces;
    OrientedBox outer = places[step];
    // The sizes of pieces allow for the four decimals of files by 1 mm.
    outer.length += 3e-3;
    outer.width += 3e-3;
    for (const CommonRoadObstacle& obstacle : scenario.obstacles) {
      ASSERT_EQ(obstacle.poses.size(), places.size());
      EXPECT_EQ(obstacle.poses[step].first, 0.1 * static_cast<double>(step));
      pieces.push_back(obstacle.box);
      pieces.back().center = obstacle.poses[step].second;
      for (const Vec2& corner : pieces.back().Corners()) {
        EXPECT_TRUE(trackbed::Contains(outer, corner)) << step;
      }
    }
    constexpr int kPoints = 40;
    // The outer sides of pieces are those of the place up to rounding.
    constexpr double kRounding = 1e-9;
    for (int i = 0; i <= kPoints; ++i) {
      for (int j = 0; j <= kPoints; ++j) {
        const Vec2 point =
            ToWorld(places[step].center,
                    {(places[step].length - kRounding) * (static_cast<double>(i) / kPoints - 0.5),
                     (places[step].width - kRounding) * (static_cast<double>(j) / kPoints - 0.5)});
        EXPECT_TRUE(
            std::any_of(pieces.begin(), pieces.end(),
                        [&](const OrientedBox& piece) { return trackbed::Contains(piece, point); }))
            << "step " << step << " at " << i << " " << j;
      }
    }
  }
}

TEST(CommonRoadScenario, ReadsCoordinatesOfAMapProjection) {
  const auto moved = [](const Vec2& by) {
    return StraightLanelet(1, by, 200.0, "") +
           PlanningProblem({by.x() + 5.0, by.y(), 0.0}, 10.0,
                           Rectangle({by.x() + 100.0, by.y()}, 10.0, 3.0), 0, 200);
  };
  const CommonRoadScenario here = Read(moved({0.0, 0.0}));
  const CommonRoadScenario there = Read(moved({691000.0, 5334000.0}));
  EXPECT_THAT(there.notes, testing::Contains(HasSubstr("relative to (691000, 5334000)")));
  ASSERT_EQ(here.route.size(), there.route.size());
  for (std::size_t i = 0; i < here.route.size(); ++i) {
    // Floating-point numbers near 5e6 m are 1e-9 m apart.
    EXPECT_NEAR((here.route[i] - there.route[i]).norm(), 0.0, Tolerance(1e-8));
  }
  EXPECT_EQ(here.speed, there.speed);
}

TEST(CommonRoadScenario, SaysWhatIsWrong) {
  const std::string problem =
      PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 0, 150);
  EXPECT_THAT(Refusal(Roads()), HasSubstr("planningProblem: missing"));
  EXPECT_THAT(Refusal(problem), HasSubstr("lanelet: missing: the file has no roads"));
  EXPECT_THAT(
      Refusal(Roads() + PlanningProblem({5.0, 50.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 0, 150)),
      HasSubstr("the start (5, 50) is in no lanelet"));
  EXPECT_THAT(
      Refusal(Roads() + PlanningProblem({5.0, 0.0, 3.1}, 10.0, "<lanelet ref=\"3\"/>", 0, 150)),
      HasSubstr("with about the direction 3.1 rad"));
  // Lanelet 2 has no lane change back to lanelet 1.
  EXPECT_THAT(
      Refusal(Roads() + PlanningProblem({5.0, 4.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 0, 150)),
      HasSubstr("no successors and lane changes lead from lanelet 2 to lanelet 3"));
  EXPECT_THAT(
      Refusal(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"8\"/>", 0, 150)),
      HasSubstr("the goal is in the lanelet 8, which is not in the file"));
  // The goal is behind the start.
  EXPECT_THAT(Refusal(Roads() + PlanningProblem({50.0, 0.0, 0.0}, 10.0,
                                                Rectangle({20.0, 0.0}, 4.0, 3.0), 0, 150)),
              HasSubstr("does not pass through the goal"));
  EXPECT_THAT(
      Refusal(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "<lanelet ref=\"3\"/>", 20, 10)),
      HasSubstr("the interval begins at 20 and ends before, at 10"));
  EXPECT_THAT(Refusal(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 1e6, "", 0, 150)),
              HasSubstr("velocity: 1000000 m/s; must be at most 100 m/s"));
  EXPECT_THAT(Refusal(Roads() + PlanningProblem({5.0, 0.0, 0.0}, 10.0, "", 0, 1000000)),
              HasSubstr("km long; must be at most 50 km"));
  EXPECT_THAT(Refusal(StraightLanelet(1, {0.0, 0.0}, 0.0, "") +
                      PlanningProblem({0.0, 0.0, 0.0}, 10.0, "", 0, 150)),
              HasSubstr("lanelet: missing: the file has no roads"));
  EXPECT_THAT(Refusal(Roads() + StraightLanelet(1, {0.0, 9.0}, 5.0, "") + problem),
              HasSubstr("two lanelets have the id 1"));
  EXPECT_THAT(Refusal(Roads() + "<lanelet id=\"5\"><leftBound/></lanelet>" + problem),
              HasSubstr("0 points; a bound has at least 2"));
  EXPECT_THAT(ErrorText([] { ReadCommonRoadScenario("z.xml", "<commonRoad>"); }),
              HasSubstr("not XML"));
  EXPECT_THAT(ErrorText([] { ReadCommonRoadScenario("z.xml", "<commonRoad/>"); }),
              HasSubstr("timeStepSize"));
}

}  // namespace
}  // namespace trackbed

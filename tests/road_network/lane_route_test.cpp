#include "trackbed/road_network/lane_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/road_network/open_drive.h"

// Tests lane routes through a network with a junction and a loop: the stretches, the path along the
// lane centers, lane changes, and errors.
namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Tolerance [m, rad] for the error of integrating the lane centers numerically, over 300 m of road
// with points 0.25 m apart.
constexpr double kOnCenter = 1e-6;

RoadNetwork Crossing() {
  return ReadOpenDrive(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/roads/crossing.xodr");
}

std::vector<std::string> RoadsOf(const LaneRoute& route) {
  std::vector<std::string> roads;
  for (const LaneStretch& stretch : route.stretches) {
    roads.push_back(stretch.road);
  }
  return roads;
}

/// Expects that the path follows the center of each stretch in the driving direction of the
/// stretch, and ends with the last stretch.
void ExpectAlongCenters(const RoadNetwork& network, const LaneRoute& route) {
  ASSERT_TRUE(route.ok()) << route.failure;
  double passed = 0.0;
  for (const LaneStretch& stretch : route.stretches) {
    const Road& road = network.roads.at(stretch.road);
    const double direction = stretch.to > stretch.from ? 0.0 : kPi;
    // Two sections of the road meet at the ends of a stretch, so the test samples the path just
    // inside the stretch.
    for (const double share : {1e-6, 0.2, 0.5, 0.8, 1.0 - 1e-6}) {
      const double s = std::lerp(stretch.from, stretch.to, share);
      const RoadPosition center = LanePositionAt(road, stretch.lane, s);
      const Projection at = route.path.Project({center.x, center.y, 0.0}, {passed, passed + 200.0});
      EXPECT_NEAR(at.cross_track, 0.0, Tolerance(kOnCenter)) << stretch.road << " at " << s;
      EXPECT_NEAR(AngleDifference(route.path.At(at.s).pose.yaw, center.heading + direction), 0.0,
                  Tolerance(kOnCenter))
          << stretch.road << " at " << s;
      EXPECT_GE(at.s, passed);
      passed = std::max(passed, at.s - 1e-3);
    }
  }
  EXPECT_NEAR(passed, route.path.length(), 2e-3);
}

TEST(LaneRoute, LeadsThroughTheJunctionAndBackAgainstTheRoad) {
  const RoadNetwork network = Crossing();
  const LaneRoute route =
      FindLaneRoute(network, {{"1", -1, 10.0}, {"2", -1, 90.0}, {"1", 1, 20.0}});
  ExpectAlongCenters(network, route);
  // The route leads from west to east through the junction, around the loop, and from north to
  // west.
  ASSERT_EQ(route.stretches.size(), 6U);
  const std::vector<std::string> roads = RoadsOf(route);
  EXPECT_EQ(roads[0], "1");
  EXPECT_EQ(network.roads.at(roads[1]).name, "W to E");
  EXPECT_EQ(roads[2], "2");
  EXPECT_EQ(roads[3], "2");
  EXPECT_EQ(network.roads.at(roads[4]).name, "N to W");
  EXPECT_EQ(roads[5], "1");
  EXPECT_EQ(route.stretches.back().from, 68.0);
  EXPECT_EQ(route.stretches.back().to, 20.0);
  EXPECT_LE(route.deviation, Tolerance(kOnCenter));
}

TEST(LaneRoute, StartsAndEndsAtItsPlaces) {
  const RoadNetwork network = Crossing();
  const LanePlace from{"3", 1, 40.0};
  const LanePlace to{"1", 1, 5.0};
  const LaneRoute route = FindLaneRoute(network, {from, to});
  ASSERT_TRUE(route.ok()) << route.failure;
  const Pose2 start = PoseAt(network, from);
  // The file rounds the heading -pi/2 with an error of 5e-13 rad, which moves a point 40 m along
  // the road by 2e-11 m.
  EXPECT_NEAR(start.x, 1.75, Tolerance(2e-11));
  EXPECT_NEAR(start.y, -60.0, Tolerance(2e-11));
  EXPECT_NEAR(start.yaw, kPi / 2.0, Tolerance(1e-12));
  const Pose2 first = route.path.At(0.0).pose;
  EXPECT_NEAR((first.position() - start.position()).norm(), 0.0, Tolerance(1e-12));
  const Pose2 end = route.path.At(route.path.length()).pose;
  EXPECT_NEAR((end.position() - Vec2(-83.0, 1.75)).norm(), 0.0, Tolerance(kOnCenter));
  EXPECT_NEAR(AngleDifference(end.yaw, kPi), 0.0, Tolerance(kOnCenter));
}

TEST(LaneRoute, TellsTheEndsOfARoadApartThatIsTwiceAtAJunction) {
  // The route from the loop's end to its start turns left at the junction. A route that goes
  // straight or turns right at the junction does not lead to the start of the loop.
  const RoadNetwork network = Crossing();
  const LaneRoute route = FindLaneRoute(network, {{"2", -1, 170.0}, {"2", -1, 5.0}});
  ExpectAlongCenters(network, route);
  ASSERT_EQ(route.stretches.size(), 3U);
  EXPECT_EQ(network.roads.at(route.stretches[1].road).name, "N to E");
}

TEST(LaneRoute, TakesTheShortestOfTwoWays) {
  const RoadNetwork network = Crossing();
  // The route leads from the west to the loop's left lane, whose direction is from north to east.
  // The shortest route turns left at once.
  const LaneRoute route = FindLaneRoute(network, {{"1", -1, 60.0}, {"2", 1, 100.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  EXPECT_EQ(network.roads.at(RoadsOf(route)[1]).name, "W to N");
  EXPECT_LT(route.stretches.back().to, route.stretches.back().from);
}

TEST(LaneRoute, MakesLinesAndArcsOneSegmentEach) {
  const LaneRoute route = FindLaneRoute(Crossing(), {{"1", -1, 0.0}, {"1", -1, 60.0}});
  ASSERT_TRUE(route.ok());
  EXPECT_THAT(route.path.segments(), ElementsAre(Segment{.length = 60.0, .curvature = 0.0}));
}

RoadText ThreeLanes() {
  RoadText road;
  road.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right>"
      "<lane id='-1' type='driving'><width sOffset='0' a='3' b='0' c='0' d='0'/></lane>"
      "<lane id='-2' type='driving'><width sOffset='0' a='3.5' b='0.005' c='0' d='0'/></lane>"
      "<lane id='-3' type='driving'><width sOffset='0' a='3' b='0' c='0' d='0'/></lane>"
      "</right></laneSection>";
  return road;
}

TEST(LaneRoute, ChangesLanesByAQuintic) {
  RoadText text = ThreeLanes();
  text.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='100'><arc curvature='0.01'/></geometry>";
  const RoadNetwork network = ParseNetwork(text.Xml());
  const LaneRoute route =
      FindLaneRoute(network, {{"1", -1, 10.0}, {"1", -1, 20.0}, {"1", -2, 60.0}, {"1", -2, 90.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  ASSERT_EQ(route.stretches.size(), 3U);
  EXPECT_EQ(route.stretches[1].lane, -1);
  EXPECT_EQ(route.stretches[1].to_lane, -2);
  for (const double s : {20.0, 27.0, 40.0, 52.0, 60.0}) {
    const double q = (s - 20.0) / 40.0;
    const double blend = q * q * q * (10.0 - 15.0 * q + 6.0 * q * q);
    const double t = std::lerp(-1.5, -3.0 - 0.5 * (3.5 + 0.005 * s), blend);
    const RoadPosition at = PositionAt(network.roads.at("1"), s, t);
    EXPECT_NEAR(route.path.Project({at.x, at.y, 0.0}).cross_track, 0.0, Tolerance(kOnCenter)) << s;
  }
  // The heading is continuous everywhere. The curvature is continuous at the station where the lane
  // change begins.
  const auto& segments = route.path.segments();
  double station = 0.0;
  for (std::size_t i = 0; i + 1 < segments.size() && station < 40.0; ++i) {
    station += segments[i].length;
    EXPECT_NEAR(segments[i].CurvatureAt(segments[i].length), segments[i + 1].curvature,
                Tolerance(1e-6))
        << station;
  }
}

TEST(LaneRoute, ChangesToNeighboringLanesAheadAlone) {
  const RoadNetwork network = ParseNetwork(ThreeLanes().Xml());
  EXPECT_THAT(FindLaneRoute(network, {{"1", -1, 10.0}, {"1", -3, 60.0}}).failure,
              HasSubstr("no linked lanes lead from lane -1 of road 1 at s = 10 m to lane -3"));
  EXPECT_THAT(FindLaneRoute(network, {{"1", -1, 60.0}, {"1", -2, 10.0}}).failure,
              HasSubstr("no linked lanes lead"));
  EXPECT_THAT(FindLaneRoute(network, {{"1", -1, 60.0}, {"1", -1, 60.0}}).failure,
              HasSubstr("no linked lanes lead"));
}

/// Returns the text of two roads. At the joint, the second road is rotated by `heading` [rad] and
/// shifted by `y` [m].
std::string TwoRoads(double heading, double y) {
  const std::string lane_links = kTwoLanes;
  RoadText first;
  first.link = "<successor elementType='road' elementId='2' contactPoint='start'/>";
  first.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<link><successor id='-1'/></link><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane>"
      "</right></laneSection>";
  RoadText second;
  second.id = "2";
  second.geometry =
      fmt::format("<geometry s='0' x='{}' y='{}' hdg='{}' length='100'><line/></geometry>",
                  // The centers of the two lanes meet at the joint.
                  100.0 - 1.75 * std::sin(heading), y - 1.75 + 1.75 * std::cos(heading), heading);
  return first.Xml() + second.Xml();
}

TEST(LaneRoute, RoundsSmallKinksAndSaysHowFarThatLeadsOff) {
  const RoadNetwork network = ParseNetwork(TwoRoads(0.02, 0.0));
  const LaneRoute route = FindLaneRoute(network, {{"1", -1, 10.0}, {"2", -1, 90.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  // The path turns by the angle a = 0.02 rad within the length L = 1 m. The path turns by the angle
  // a = 0.02 rad within the length L = 1 m at the corner. With q = d/L, where d is the distance
  // from the start of the turn, the heading is a (3 q^2 - 2 q^3). In the middle of the turn, at the
  // corner, q is 1/2 and the path deviates by 3/32 a L. The relative error of this formula is a^2.
  EXPECT_NEAR(route.deviation, 3.0 / 32.0 * 0.02, Tolerance(1e-6));
  const Pose2 end = route.path.At(route.path.length()).pose;
  EXPECT_NEAR(end.yaw, 0.02, Tolerance(1e-9));
  const RoadPosition goal = LanePositionAt(network.roads.at("2"), -1, 90.0);
  EXPECT_NEAR(std::hypot(end.x - goal.x, end.y - goal.y), 0.0, Tolerance(1e-3));
}

TEST(LaneRoute, RefusesLanesThatDoNotMeet) {
  const std::vector<LanePlace> places{{"1", -1, 10.0}, {"2", -1, 90.0}};
  EXPECT_THAT(
      FindLaneRoute(ParseNetwork(TwoRoads(0.3, 0.0)), places).failure,
      HasSubstr("road 2, lane -1: the lanes' centers have a kink of 0.3 rad (at most 0.2) at x = "
                "100 m, y = -1.75 m; choose a route around this place"));
  EXPECT_THAT(FindLaneRoute(ParseNetwork(TwoRoads(0.0, 0.2)), places).failure,
              HasSubstr("road 2, lane -1: the lanes' centers are 0.2 m apart"));
  const LaneRoute near = FindLaneRoute(ParseNetwork(TwoRoads(0.0, 0.03)), places);
  ASSERT_TRUE(near.ok()) << near.failure;
  // The path moves by half of the gap before the gap and by the other half beyond it. The segments
  // through points 0.25 m apart follow the move to 1e-5 m.
  EXPECT_NEAR(near.deviation, 0.015, Tolerance(1e-5));
}

/// A lane whose width begins to grow by 0.1 at s = 50 m: its center has a kink of atan(0.05) there.
RoadText KinkedLane() {
  const std::string lane =
      "type='driving'>"
      "<width sOffset='0' a='3.5' b='0' c='0' d='0'/>"
      "<width sOffset='50' a='3.5' b='0.1' c='0' d='0'/></lane>";
  RoadText road;
  road.lanes = "<laneSection s='0'><left><lane id='1' " + lane +
               "</left><center><lane id='0'/></center><right><lane id='-1' " + lane +
               "</right></laneSection>";
  return road;
}

TEST(LaneRoute, BeginsAtThePoseOfItsFirstPlaceBesideAKink) {
  const RoadNetwork network = ParseNetwork(KinkedLane().Xml());
  for (const double s : {49.9, 49.985, 49.995, 50.0, 50.005, 50.015, 50.1}) {
    for (const int lane : {-1, 1}) {
      const LanePlace start{"1", lane, s};
      const LaneRoute route = FindLaneRoute(network, {start, {"1", lane, lane < 0 ? 90.0 : 10.0}});
      ASSERT_TRUE(route.ok()) << route.failure;
      const Pose2 pose = PoseAt(network, start);
      const Pose2 path = route.path.At(0.0).pose;
      // Both evaluate the same polynomials.
      EXPECT_NEAR(AngleDifference(pose.yaw, path.yaw), 0.0, Tolerance(1e-12)) << s << " " << lane;
      EXPECT_LT((pose.position() - path.position()).norm(), Tolerance(1e-9)) << s << " " << lane;
    }
  }
}

TEST(LaneRoute, RefusesALaneBeyondTheCenterOfCurvature) {
  RoadText road = ThreeLanes();
  road.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='100'><arc curvature='-0.2'/></geometry>";
  const RoadNetwork network = ParseNetwork(road.Xml());
  EXPECT_THAT(FindLaneRoute(network, {{"1", -3, 10.0}, {"1", -3, 60.0}}).failure,
              HasSubstr("lane -3 lies beyond"));
  EXPECT_TRUE(FindLaneRoute(network, {{"1", -1, 10.0}, {"1", -1, 60.0}}).ok());
}

// One wrong coefficient makes the lanes zigzag, or takes them far aside.
TEST(LaneRoute, RefusesLanesThatTurnTooMuch) {
  const std::vector<LanePlace> route{{"1", -1, 10.0}, {"1", -1, 60.0}};
  RoadText road = ThreeLanes();
  for (const std::string bank : {"c='2' d='0'", "c='-7' d='0'", "c='0' d='0.5'"}) {
    road.heights =
        "<lateralProfile><superelevation s='0' a='0' b='0' " + bank + "/></lateralProfile>";
    const LaneRoute found = FindLaneRoute(ParseNetwork(road.Xml()), route);
    EXPECT_THAT(found.failure, AllOf(HasSubstr("road 1: the center of lane -1 turns by "),
                                     HasSubstr("correct the widths, offset or superelevation")))
        << bank;
  }
}

TEST(LaneRoute, RefusesLanesThatAreTooLong) {
  const std::vector<LanePlace> route{{"1", -1, 10.0}, {"1", -1, 60.0}};
  RoadText road = ThreeLanes();
  road.lanes = "<laneOffset s='0' a='0' b='5000' c='0' d='0'/>" + road.lanes;
  // The lanes between 10 and 60 m are 50 * sqrt(1 + 5000^2) m = 250 km long.
  EXPECT_THAT(FindLaneRoute(ParseNetwork(road.Xml()), route).failure,
              HasSubstr("longer than 200 km: up to lane -1 of road 1, 2.5e+05 m"));
}

/// A road that curves, climbs and banks, with widening lanes.
std::string BankedRoad() {
  RoadText road;
  road.geometry =
      "<geometry s='0' x='3' y='-2' hdg='0.4' length='100'>"
      "<spiral curvStart='0.0' curvEnd='0.02'/></geometry>";
  road.heights =
      "<elevationProfile><elevation s='0' a='2' b='0.05' c='0.001' d='-0.00001'/>"
      "</elevationProfile><lateralProfile>"
      "<superelevation s='0' a='0' b='0' c='0.0002' d='-0.000002'/>"
      "<superelevation s='50' a='0.25' b='0.005' c='-0.0001' d='0'/></lateralProfile>";
  return road.Xml();
}

// The lanes of a steep bank are t cos(roll) from the reference line, seen from above.
TEST(LaneRoute, FollowsLanesOnABank) {
  const RoadNetwork network = ParseNetwork(BankedRoad());
  const LaneRoute route = FindLaneRoute(network, {{"1", 1, 95.0}, {"1", 1, 5.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  const Road& road = network.roads.at("1");
  for (double s = 6.0; s < 95.0; s += 1.7) {
    const RoadPosition center = LanePositionAt(road, 1, s);
    const Projection at = route.path.Project({center.x, center.y, 0.0});
    EXPECT_NEAR(at.cross_track, 0.0, Tolerance(kOnCenter)) << s;
  }
}

TEST(LaneRoute, HasTheHeadingAndCurvatureOfLanesOnABank) {
  const RoadNetwork network = ParseNetwork(BankedRoad());
  const Road& road = network.roads.at("1");
  const auto at = [&](double s) {
    const RoadPosition center = LanePositionAt(road, -1, s);
    return Vec2(center.x, center.y);
  };
  for (double s = 3.0; s < 97.0; s += 3.1) {
    const SurfaceLine line = SurfaceLineAt(road, LaneBordersAt(road, -1, s).Center(), s, s);
    // Central differences with the step h have errors of h^2 times the third derivatives, which are
    // about 1e-3, and of 1e-14/h^2 from rounding.
    constexpr double kStep = 1e-3;
    const Vec2 first = (at(s + kStep) - at(s - kStep)) / (2.0 * kStep);
    const Vec2 second = (at(s + kStep) - 2.0 * at(s) + at(s - kStep)) / (kStep * kStep);
    EXPECT_NEAR((line.position - at(s)).norm(), 0.0, Tolerance(1e-12)) << s;
    EXPECT_NEAR(line.speed, first.norm(), Tolerance(1e-8)) << s;
    EXPECT_NEAR(AngleDifference(line.heading, std::atan2(first.y(), first.x())), 0.0,
                Tolerance(1e-8))
        << s;
    EXPECT_NEAR(line.curvature, Cross(first, second) / std::pow(first.norm(), 3.0), Tolerance(1e-7))
        << s;
    const Pose2 pose = PoseAt(network, {"1", -1, s});
    EXPECT_NEAR(AngleDifference(pose.yaw, line.heading), 0.0, Tolerance(1e-14));
  }
}

// At the joint, the second derivative of the roll angle r steps by 6e-4 rad/m^2. The lane is at t =
// -2 m, which is t cos(r) from the reference line seen from above. Its curvature steps by about t
// sin(r) times as much, 1.2e-4 1/m. The route joins the lane without this step, because a planner
// would slow down for a step.
TEST(LaneRoute, RoundsSmallStepsOfCurvature) {
  RoadText road;
  road.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='100'><arc curvature='0.01'/></geometry>";
  road.heights =
      "<lateralProfile><superelevation s='0' a='0.1' b='0' c='0' d='0'/>"
      "<superelevation s='50' a='0.1' b='0' c='-0.0003' d='0'/></lateralProfile>";
  const RoadNetwork network = ParseNetwork(road.Xml());
  const Road& own = network.roads.at("1");
  const CubicValue center = LaneBordersAt(own, -1, 50.0).Center();
  const double before = SurfaceLineAt(own, center, 50.0, 25.0).curvature;
  const double after = SurfaceLineAt(own, center, 50.0, 75.0).curvature;
  EXPECT_GT(std::abs(after - before), 1e-4);  // the road has the step
  const LaneRoute route = FindLaneRoute(network, {{"1", -1, 5.0}, {"1", -1, 95.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  const std::vector<Segment>& segments = route.path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    // SegmentsThrough passes its points with the rounding of a few operations on 0.01 1/m.
    EXPECT_NEAR(segments[i - 1].CurvatureAt(segments[i - 1].length), segments[i].curvature,
                Tolerance(1e-12))
        << i;
  }
}

/// Three roads of 100 m in a row along the x axis. The lanes of the middle one are `lanes`.
std::string ThreeRoads(const std::string& lanes) {
  std::string all;
  for (int i = 1; i <= 3; ++i) {
    RoadText road;
    road.id = std::to_string(i);
    road.geometry = fmt::format(
        "<geometry s='0' x='{}' y='0' hdg='0' length='100'><line/></geometry>", 100 * (i - 1));
    if (i < 3) {
      road.link =
          fmt::format("<successor elementType='road' elementId='{}' contactPoint='start'/>", i + 1);
    }
    road.lanes =
        "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
        "<link><successor id='-1'/></link><width sOffset='0' a='3' b='0' c='0' d='0'/></lane>"
        "</right></laneSection>";
    if (i == 2 && !lanes.empty()) {
      road.lanes = lanes;
    }
    all += road.Xml();
  }
  return all;
}

TEST(LaneRoute, NamesTheBrokenPartThatItNeeds) {
  const std::vector<LanePlace> through{{"1", -1, 5.0}, {"3", -1, 50.0}};
  EXPECT_TRUE(FindLaneRoute(ParseNetwork(ThreeRoads("")), through).ok());
  const RoadNetwork broken = ParseNetwork(ThreeRoads("<laneSection s='0'/>"));
  EXPECT_THAT(FindLaneRoute(broken, through).failure,
              AllOf(HasSubstr("no linked lanes lead"),
                    HasSubstr("road 2 is left out, because of line "), HasSubstr("center")));
  EXPECT_TRUE(FindLaneRoute(broken, {{"1", -1, 5.0}, {"1", -1, 50.0}}).ok());
  EXPECT_THAT(LanePlaceError(broken, {"2", -1, 5.0}), HasSubstr("road 2 is left out"));
  const RoadNetwork dangling = ParseNetwork(
      ThreeRoads("<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' "
                 "type='driving'><link><successor id='-4'/></link>"
                 "<width sOffset='0' a='3' b='0' c='0' d='0'/></lane></right></laneSection>"));
  EXPECT_THAT(FindLaneRoute(dangling, through).failure,
              HasSubstr("lane -4 of road 3 at s = 0 m, to which lane -1 of road 2 leads, is not "
                        "in the file"));
}

TEST(LaneRoute, EndsWhereLinksGoInCircles) {
  // Each road is its own successor, and no road leads to the other road.
  RoadText ring;
  ring.length = "62.83185307179586";
  ring.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='62.83185307179586'><arc curvature='0.1'/>"
      "</geometry>";
  ring.link =
      "<predecessor elementType='road' elementId='1' contactPoint='end'/>"
      "<successor elementType='road' elementId='1' contactPoint='start'/>";
  ring.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<link><predecessor id='-1'/><successor id='-1'/></link>"
      "<width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane></right></laneSection>";
  RoadText other;
  other.id = "2";
  const RoadNetwork network = ParseNetwork(ring.Xml() + other.Xml());
  EXPECT_THAT(FindLaneRoute(network, {{"1", -1, 10.0}, {"2", -1, 10.0}}).failure,
              HasSubstr("no linked lanes lead"));
  // The route is one lap that ends 1 m before its start. Its lane center has a radius of 11.75 m
  // and a circumference of 2 pi 11.75 m. A distance of 1 m along the road, whose radius is 10 m, is
  // 1.175 m along the lane center.
  const LaneRoute around = FindLaneRoute(network, {{"1", -1, 10.0}, {"1", -1, 9.0}});
  ASSERT_TRUE(around.ok()) << around.failure;
  EXPECT_NEAR(around.path.length(), 2.0 * kPi * 11.75 - 1.175, Tolerance(kOnCenter));
}

TEST(LaneRoute, IsNoLongerThanAHundredKilometers) {
  RoadText road;
  road.length = "1e6";
  road.geometry = "<geometry s='0' x='0' y='0' hdg='0' length='1e6'><line/></geometry>";
  EXPECT_THAT(FindLaneRoute(ParseNetwork(road.Xml()), {{"1", -1, 0.0}, {"1", -1, 2e5}}).failure,
              HasSubstr("longer than 100 km"));
}

TEST(LaneRoute, SaysWhatIsWrongWithAPlace) {
  const RoadNetwork network = Crossing();
  EXPECT_EQ(LanePlaceError(network, {"1", -1, 10.0}), "");
  EXPECT_THAT(LanePlaceError(network, {"westt", -1, 10.0}), HasSubstr("unknown road 'westt'"));
  EXPECT_THAT(LanePlaceError(network, {"1", -1, 69.0}),
              HasSubstr("s = 69 m is not on road 1; must be between 0 and 68 m"));
  EXPECT_THAT(
      LanePlaceError(network, {"1", -2, 10.0}),
      HasSubstr("road 1 has no lane -2 to drive on at s = 10 m, but a shoulder lane; it has "
                "1, -1"));
  EXPECT_THAT(LanePlaceError(network, {"1", 7, 10.0}), HasSubstr("no lane 7"));
  EXPECT_THAT(LanePlaceError(network, {"1", 0, 10.0}), HasSubstr("no lane 0"));
  EXPECT_NE(LanePlaceError(network, {"1", -1, std::nan("")}), "");
  EXPECT_THROW(FindLaneRoute(network, {{"1", -1, 10.0}}), PreconditionError);
  EXPECT_THROW(FindLaneRoute(network, {{"1", -1, 10.0}, {"9", -1, 1.0}}), PreconditionError);
  EXPECT_THROW(PoseAt(network, {"9", -1, 1.0}), PreconditionError);
}

}  // namespace
}  // namespace trackbed

#include "trackbed/planning/lanes/route_ground.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

// Tests the ground along a lane route: against closed forms of planes and parabolas, against the
// heights of the lanes, beside the lanes, at the ends of roads and at joints.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

std::string Roll(double a) {
  return fmt::format(
      "<lateralProfile><superelevation s='0' a='{}' b='0' c='0' d='0'/></lateralProfile>", a);
}

const std::vector<LanePlace> kAlong{{"1", -1, 10.0}, {"1", -1, 90.0}};

/// Returns the ground of one straight road to the east with the given heights.
RouteGround OnStraight(const std::string& heights) {
  RoadText road;
  road.heights = heights;
  return MakeRouteGround(ParseNetwork(road.Xml()), kAlong);
}

/// Returns the largest distance [m] between points on a road's drivable lanes and the ground.
double LargestDistance(const Road& road, double from, double to, const Terrain& terrain) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> station(from, to);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  double largest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double s = station(random);
    const int lane = i % 2 == 0 ? 1 : -1;
    const double offset = part(random) * LaneBordersAt(road, lane, s).Width();
    const RoadPosition at = LanePositionAt(road, lane, s, offset);
    largest = std::max(largest, std::abs(terrain.At({at.x, at.y}).height - at.z));
  }
  return largest;
}

TEST(RouteGround, IsNoneOfLevelRoads) {
  const RouteGround ground = OnStraight("");
  EXPECT_TRUE(ground.ok());
  EXPECT_EQ(ground.terrain, nullptr);
  EXPECT_EQ(OnStraight(Elevation(7.0, 0.0, 0.0)).terrain, nullptr);
}

// A crown: both lanes fall by 2.5 % from the center, with 1 m of parabola in the middle.
TEST(RouteGround, HasTheProfileAcrossTheRoad) {
  RoadText road;
  road.heights =
      "<lateralProfile>"
      "<shape s='0' t='-8' a='-0.1875' b='0.025' c='0' d='0'/>"
      "<shape s='0' t='-0.5' a='0' b='0.025' c='-0.025' d='0'/>"
      "<shape s='0' t='0.5' a='0' b='-0.025' c='0' d='0'/></lateralProfile>";
  const RoadNetwork network = ParseNetwork(road.Xml());
  const RouteGround ground = MakeRouteGround(network, kAlong);
  ASSERT_TRUE(ground.ok()) << ground.failure;
  ASSERT_NE(ground.terrain, nullptr);
  for (double t = -3.4; t < 3.5; t += 0.2) {
    const double away = std::abs(t);
    const double height = away > 0.5 ? -0.025 * (away - 0.5) : 0.025 * (0.25 - t * t);
    // The ground of the route may deviate from the surface of the lanes by 1 cm, because it is
    // interpolated. On planes, the interpolation is exact.
    EXPECT_NEAR(ground.terrain->At({50.0, t}).height, height, Tolerance(away > 1.0 ? 1e-6 : 0.01))
        << t;
  }
}

TEST(RouteGround, HasConstantGradeAndBank) {
  const double roll = 0.1;
  const RouteGround ground = OnStraight(Elevation(5.0, 0.06, 0.0) + Roll(roll));
  ASSERT_TRUE(ground.ok()) << ground.failure;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(10.0, 90.0);
  std::uniform_real_distribution<double> y(-3.3, 3.3);
  for (int i = 0; i < 1000; ++i) {
    // The ground is a plane with a grade of 6 % along x, tilted by the roll about the rising
    // reference line. The roll lifts a point and moves it back along x, so the slope across the
    // road is tan(roll) sqrt(1 + 0.06^2).
    const Vec2 p(x(random), y(random));
    const double grade = 0.06;
    const double across = std::tan(roll) * std::sqrt(1.0 + grade * grade);
    const Terrain::Point at = ground.terrain->At(p);
    // Beside the lanes, the height is a weighted mean over neighboring strips of the road, which
    // become level beyond their ends. At a lateral distance of 1 m, a strip that ends 5 m away has
    // the weight 1/700. The height of this strip errs by 0.06 (5 - 10 (1 - e^-0.5)) m = 64 mm, so
    // the weighted mean errs by 0.1 mm. Cubic convolution adds 1/16 of this error from two
    // neighboring points to the height at the border of the lane, and 1/16 per cell of 0.5 m to the
    // slope there.
    EXPECT_NEAR(at.height, 5.0 + grade * p.x() + across * p.y(), Tolerance(2e-5));
    EXPECT_NEAR(at.slope.x(), grade, Tolerance(2e-4));
    EXPECT_NEAR(at.slope.y(), across, Tolerance(2e-4));
  }
}

TEST(RouteGround, HasTheParabolaOfAHill) {
  const RouteGround ground = OnStraight(Elevation(0.0, 0.08, -0.0008));
  ASSERT_TRUE(ground.ok()) << ground.failure;
  for (double x = 10.0; x < 90.0; x += 0.37) {
    const Terrain::Point at = ground.terrain->At({x, -1.75});
    EXPECT_NEAR(at.height, 0.08 * x - 0.0008 * x * x, Tolerance(5e-6));  // See the tolerance above.
    EXPECT_NEAR(at.slope.x(), 0.08 - 0.0016 * x, Tolerance(1e-4));
  }
}

TEST(RouteGround, IsOnEveryLaneOfTheHillPassToAMillimeter) {
  const RoadNetwork network =
      ReadOpenDrive(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/roads/hill_pass.xodr");
  const RouteGround ground = MakeRouteGround(network, {{"1", -1, 8.0}, {"2", -1, 165.0}});
  ASSERT_TRUE(ground.ok()) << ground.failure;
  EXPECT_LE(LargestDistance(network.roads.at("1"), 0.0, 220.0, *ground.terrain), Tolerance(1e-3));
  EXPECT_LE(LargestDistance(network.roads.at("2"), 0.0, 180.0, *ground.terrain), Tolerance(1e-3));
  EXPECT_LE(ground.deviation, Tolerance(1e-3));
  EXPECT_GT(ground.deviation, 0.0);
}

TEST(RouteGround, GoesOnSmoothlyBesideTheLanes) {
  const RouteGround ground = OnStraight(Elevation(0.0, 0.08, -0.0008) + Roll(-0.08));
  ASSERT_TRUE(ground.ok()) << ground.failure;
  const Terrain& terrain = *ground.terrain;
  for (double x = -140.0; x < 240.0; x += 7.3) {
    double last = terrain.At({x, -150.0}).height;
    for (double y = -150.0; y < 150.0; y += 0.05) {
      const double height = terrain.At({x, y}).height;
      // The slope must be below 45 degrees everywhere.
      EXPECT_LE(std::abs(height - last), 0.05) << x << " " << y;
      last = height;
    }
  }
  EXPECT_EQ(terrain.At({50.0, 400.0}).height, terrain.size().base);
  EXPECT_LT(terrain.size().base, 0.0);
}

TEST(RouteGround, GoesOnStraightWhereTheRoadEnds) {
  RoadText road;
  road.heights = Elevation(0.0, 0.08, 0.0);
  const RouteGround ground =
      MakeRouteGround(ParseNetwork(road.Xml()), {{"1", -1, 0.0}, {"1", -1, 100.0}});
  ASSERT_TRUE(ground.ok()) << ground.failure;
  for (const double x : {-5.0, -2.0, 102.0, 105.0}) {
    EXPECT_NEAR(ground.terrain->At({x, -1.75}).height, 0.08 * x, Tolerance(5e-6)) << x;
  }
}

/// Returns the ground of road 1 to the east and road 2 behind it. At the joint, road 2 has the
/// given height [m] and slope.
RouteGround OnTwoRoads(double height, double slope) {
  RoadText first;
  first.heights = Elevation(0.0, 0.05, 0.0);
  first.link = "<successor elementType='road' elementId='2' contactPoint='start'/>";
  first.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<link><successor id='-1'/></link><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane>"
      "</right></laneSection>";
  RoadText second;
  second.id = "2";
  second.geometry = "<geometry s='0' x='100' y='0' hdg='0' length='100'><line/></geometry>";
  second.heights = Elevation(height, slope, 0.0);
  return MakeRouteGround(ParseNetwork(first.Xml() + second.Xml()),
                         {{"1", -1, 10.0}, {"2", -1, 60.0}});
}

TEST(RouteGround, HasNoStepWhereRoadsMeet) {
  const RouteGround ground = OnTwoRoads(5.0, 0.05);
  ASSERT_TRUE(ground.ok()) << ground.failure;
  for (double x = 97.0; x < 103.0; x += 0.01) {
    EXPECT_NEAR(ground.terrain->At({x, -1.0}).height, 0.05 * x, Tolerance(5e-6));
  }
  // A step of 5 mm is blended within one cell on either side of the joint.
  const RouteGround mended = OnTwoRoads(5.005, 0.05);
  ASSERT_TRUE(mended.ok()) << mended.failure;
  EXPECT_NEAR(mended.terrain->At({99.0, -1.0}).height, 4.95, Tolerance(5e-6));
  EXPECT_NEAR(mended.terrain->At({101.0, -1.0}).height, 5.055, Tolerance(5e-6));
}

TEST(RouteGround, RefusesSteps) {
  EXPECT_THAT(OnTwoRoads(5.2, 0.05).failure, HasSubstr("has a step or a kink at s = "));
  EXPECT_EQ(OnTwoRoads(5.2, 0.05).terrain, nullptr);
  EXPECT_THAT(OnTwoRoads(5.2, 0.05).failure, HasSubstr("must be at most 0.01 m"));
}

/// Returns the ground of a route that crosses itself. Road 1 leads east, road 2 turns left by 270
/// degrees, and road 3 leads south over or under road 1.
RouteGround OnLoop(double grade, bool with_third) {
  constexpr double kRadius = 40.0;
  const double length = 1.5 * kPi * kRadius;
  const std::string lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<link>{}</link><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane></right></laneSection>";
  const std::string on = "<predecessor id='-1'/><successor id='-1'/>";
  RoadText first;
  first.heights = Elevation(0.0, 0.0, 0.0);
  first.link = "<successor elementType='road' elementId='2' contactPoint='start'/>";
  first.lanes = fmt::format(fmt::runtime(lanes), "<successor id='-1'/>");
  RoadText second;
  second.id = "2";
  second.length = fmt::format("{}", length);
  second.geometry = fmt::format(
      "<geometry s='0' x='100' y='0' hdg='0' length='{}'><arc curvature='{}'/></geometry>", length,
      1.0 / kRadius);
  // The slope is continuous at the start of road 2, and rises from 0 to `grade`.
  second.heights = Elevation(0.0, 0.0, 0.5 * grade / length);
  second.link =
      "<predecessor elementType='road' elementId='1' contactPoint='end'/>"
      "<successor elementType='road' elementId='3' contactPoint='start'/>";
  second.lanes = fmt::format(fmt::runtime(lanes), on);
  RoadText third;
  third.id = "3";
  third.geometry =
      "<geometry s='0' x='60' y='40' hdg='-1.5707963267948966' length='100'><line/>"
      "</geometry>";
  third.heights = Elevation(0.5 * grade * length, grade, 0.0);
  third.link = "<predecessor elementType='road' elementId='2' contactPoint='end'/>";
  third.lanes = fmt::format(fmt::runtime(lanes), "<predecessor id='-1'/>");
  const LanePlace goal = with_third ? LanePlace{"3", -1, 90.0} : LanePlace{"2", -1, 100.0};
  return MakeRouteGround(ParseNetwork(first.Xml() + second.Xml() + third.Xml()),
                         {{"1", -1, 10.0}, goal});
}

TEST(RouteGround, RefusesRoutesOverThemselvesButNotOtherRoadsThere) {
  const std::string why = OnLoop(0.05, true).failure;
  EXPECT_THAT(why, HasSubstr("road 1 at s = "));
  EXPECT_THAT(why, HasSubstr("and road 3 at s = "));
  EXPECT_THAT(why, HasSubstr("m above each other at x = "));
  const RouteGround part = OnLoop(0.05, false);
  EXPECT_TRUE(part.ok()) << part.failure;
  EXPECT_NE(part.terrain, nullptr);
}

TEST(RouteGround, RefusesWhatIsNotRead) {
  EXPECT_THAT(OnStraight("<lateralProfile><crossfall side='both' s='0' a='0.02' b='0' c='0' d='0'/>"
                         "</lateralProfile>")
                  .failure,
              HasSubstr("road 1 has heights that are not read: crossfall"));
}

TEST(RouteGround, RefusesWallsAndWhatIsTooLarge) {
  EXPECT_THAT(OnStraight(Elevation(0.0, 1.5, 0.0)).failure,
              HasSubstr("must be at most 45 degrees steep"));
  EXPECT_THAT(OnStraight(Roll(3.0)).failure, HasSubstr("must be at most 45 degrees steep"));
  EXPECT_THAT(OnStraight("<lateralProfile><shape s='0' t='-8' a='0' b='1.5' c='0' d='0'/>"
                         "</lateralProfile>")
                  .failure,
              HasSubstr("road 1 at s = 0 m has a slope of 1.5 across lane"));
  EXPECT_THAT(OnStraight("<lateralProfile><shape s='0' t='-8' a='1e8' b='0' c='0' d='0'/>"
                         "</lateralProfile>")
                  .failure,
              HasSubstr("road 1 at s = 0 m is 1e+08 m high"));
  EXPECT_THAT(OnStraight(Elevation(1e9, 0.1, 0.0)).failure,
              HasSubstr("is 1e+09 m high; must be at least -10000 and at most 10000"));
  RoadText road;
  road.heights = Elevation(0.0, 0.01, 0.0);
  road.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<width sOffset='0' a='3000' b='0' c='0' d='0'/></lane></right></laneSection>";
  EXPECT_THAT(MakeRouteGround(ParseNetwork(road.Xml()), kAlong).failure,
              HasSubstr("lane -1 of road 1 reaches 3000 m from the reference line"));
  road.lanes = kTwoLanes;
  road.length = "9000";
  road.geometry = "<geometry s='0' x='0' y='0' hdg='0' length='9000'><line/></geometry>";
  EXPECT_THAT(
      MakeRouteGround(ParseNetwork(road.Xml()), {{"1", -1, 10.0}, {"1", -1, 8990.0}}).failure,
      HasSubstr("more than 8 km"));
}

}  // namespace
}  // namespace trackbed

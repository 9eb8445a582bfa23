#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/road_network/open_drive.h"

namespace trackbed {
namespace {

// Rounding error [m] of a few operations on coordinates below 100 m.
constexpr double kRoundingOfPositions = 1e-12;

Road ReadOne(const RoadText& road) {
  return ParseOpenDrive(Document(road.Xml()), "test.xodr").roads.at("1");
}

TEST(Position, OfAStraightRoadIsPlain) {
  const Road road = ReadOne({});
  const RoadPosition at = PositionAt(road, 12.0, 3.0);
  EXPECT_EQ(at.x, 12.0);
  EXPECT_EQ(at.y, 3.0);
  EXPECT_EQ(at.z, 0.0);
  EXPECT_EQ(at.heading, 0.0);
  EXPECT_EQ(LanePositionAt(road, -1, 12.0).y, -1.75);
  EXPECT_EQ(LanePositionAt(road, 1, 12.0, 0.5).y, 2.25);
  EXPECT_EQ(LanePositionAt(road, 0, 12.0).y, 0.0);
}

TEST(Position, BesideAnArcLiesOnAConcentricCircle) {
  RoadText text;
  text.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='100'><arc curvature='0.02'/></geometry>";
  const Road road = ReadOne(text);
  for (const double s : {0.0, 40.0, 100.0}) {
    const RoadPosition at = PositionAt(road, s, -5.0);
    EXPECT_NEAR(std::hypot(at.x, at.y - 50.0), 55.0, Tolerance(kRoundingOfPositions));
    EXPECT_NEAR(at.heading, 0.02 * s, Tolerance(kRoundingOfPositions));
  }
}

TEST(Position, RollsAboutTheReferenceLine) {
  RoadText text;
  text.heights =
      "<elevationProfile><elevation s='0' a='7' b='0' c='0' d='0'/></elevationProfile>"
      "<lateralProfile><superelevation s='0' a='0.1' b='0' c='0' d='0'/></lateralProfile>";
  const RoadPosition left = PositionAt(ReadOne(text), 50.0, 4.0);
  // Positive superelevation lifts the left side.
  EXPECT_NEAR(left.x, 50.0, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(left.y, 4.0 * std::cos(0.1), Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(left.z, 7.0 + 4.0 * std::sin(0.1), Tolerance(kRoundingOfPositions));
}

// Heights across the road: records at s = 0 and s = 100, linear in between.
TEST(Position, AddsTheProfileAcrossTheRoad) {
  RoadText text;
  text.heights =
      "<lateralProfile>"
      "<shape s='0' t='-10' a='0' b='0' c='0' d='0'/>"
      "<shape s='0' t='0' a='0' b='0.1' c='0.02' d='-0.001'/>"
      "<shape s='100' t='-10' a='1' b='-0.1' c='0' d='0'/></lateralProfile>";
  const Road road = ReadOne(text);
  EXPECT_TRUE(road.unread_heights.empty());
  EXPECT_FALSE(IsLevel(road));
  for (const double s : {0.0, 30.0, 100.0}) {
    for (const double t : {-12.0, -4.0, 0.0, 3.0}) {
      const double first = t < 0.0 ? 0.0 : 0.1 * t + 0.02 * t * t - 0.001 * t * t * t;
      const double last = 1.0 - 0.1 * (t + 10.0);
      EXPECT_NEAR(PositionAt(road, s, t).z, first + 0.01 * s * (last - first),
                  Tolerance(kRoundingOfPositions));
    }
  }
}

// RoadRunner writes profiles of zero.
TEST(Position, IgnoresProfilesOfZero) {
  RoadText text;
  text.heights =
      "<lateralProfile><superelevation s='0' a='0' b='0' c='0' d='0'/>"
      "<shape s='0' t='-14' a='0' b='0' c='0' d='0'/>"
      "<crossfall side='both' s='0' a='0' b='0' c='0' d='0'/></lateralProfile>";
  EXPECT_TRUE(IsLevel(ReadOne(text)));
}

TEST(Position, RollsAboutTheTangentInSpace) {
  RoadText text;
  text.heights =
      "<elevationProfile><elevation s='0' a='0' b='0.75' c='0' d='0'/></elevationProfile>"
      "<lateralProfile><superelevation s='0' a='0.3' b='0' c='0' d='0'/></lateralProfile>";
  const RoadPosition at = PositionAt(ReadOne(text), 40.0, 2.0);
  // The tangent of the road is (0.8, 0, 0.6). The roll by 0.3 rad turns the left normal (0, 1, 0)
  // to cos(0.3) (0, 1, 0) + sin(0.3) (-0.6, 0, 0.8).
  EXPECT_NEAR(at.x, 40.0 - 2.0 * 0.6 * std::sin(0.3), Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(at.y, 2.0 * std::cos(0.3), Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(at.z, 30.0 + 2.0 * 0.8 * std::sin(0.3), Tolerance(kRoundingOfPositions));
}

TEST(Position, OfLanesSumsWidthsFromTheLaneOffset) {
  RoadText text;
  text.lanes =
      "<laneOffset s='0' a='1' b='0.01' c='0' d='0'/>"
      "<laneSection s='0'><center><lane id='0'/></center></laneSection>"
      "<laneSection s='20'><left>"
      "<lane id='2' type='driving'><width sOffset='0' a='2' b='0' c='0' d='0'/></lane>"
      "<lane id='1' type='driving'><width sOffset='0' a='3' b='0.1' c='0' d='0'/>"
      "<width sOffset='10' a='4' b='0' c='0' d='0'/></lane></left>"
      "<center><lane id='0'/></center></laneSection>";
  const Road road = ReadOne(text);
  const LaneBorders first = LaneBordersAt(road, 1, 25.0);
  EXPECT_NEAR(first.inner.value, 1.25, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(first.outer.value, 1.25 + 3.5, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(first.outer.slope, 0.01 + 0.1, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(first.Width(), 3.5, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(LaneBordersAt(road, 2, 35.0).Center().value, 1.35 + 4.0 + 1.0,
              Tolerance(kRoundingOfPositions));
  EXPECT_THROW(LaneBordersAt(road, 1, 10.0), PreconditionError);
  EXPECT_THROW(LaneBordersAt(road, -1, 25.0), PreconditionError);
}

TEST(Position, TakesBordersAsTheyAre) {
  RoadText text;
  text.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right>"
      "<lane id='-1' type='driving'><border sOffset='0' a='-3' b='0' c='0' d='0'/></lane>"
      "<lane id='-2' type='driving'><border sOffset='0' a='-7' b='0.01' c='0' d='0'/></lane>"
      "</right></laneSection>";
  const Road road = ReadOne(text);
  EXPECT_NEAR(LanePositionAt(road, -1, 0.0).y, -1.5, Tolerance(kRoundingOfPositions));
  EXPECT_NEAR(LanePositionAt(road, -2, 100.0).y, -4.5, Tolerance(kRoundingOfPositions));
}

TEST(Position, RefusesPlacesOffTheRoadAndNumbersThatAreNone) {
  const Road road = ReadOne({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PositionAt(road, -0.01, 0.0), PreconditionError);
  EXPECT_THROW(PositionAt(road, 100.01, 0.0), PreconditionError);
  EXPECT_THROW(PositionAt(road, nan, 0.0), PreconditionError);
  EXPECT_THROW(PositionAt(road, 1.0, nan), PreconditionError);
  EXPECT_THROW(LanePositionAt(road, 2, 1.0), PreconditionError);
  EXPECT_EQ(PositionAt(road, 100.0005, 0.0).x, 100.0);
}

TEST(Position, KnowsWhetherARoadIsLevel) {
  EXPECT_TRUE(IsLevel(ReadOne({})));
  const auto with = [](const std::string& heights) {
    RoadText text;
    text.heights = heights;
    return ReadOne(text);
  };
  const std::string rest = " c='0' d='0'/>";
  EXPECT_TRUE(IsLevel(
      with("<elevationProfile><elevation s='0' a='5' b='0'" + rest + "</elevationProfile>")));
  EXPECT_FALSE(IsLevel(
      with("<elevationProfile><elevation s='0' a='5' b='0.01'" + rest + "</elevationProfile>")));
  EXPECT_FALSE(IsLevel(with("<elevationProfile><elevation s='0' a='5' b='0'" + rest +
                            "<elevation s='50' a='6' b='0'" + rest + "</elevationProfile>")));
  EXPECT_FALSE(IsLevel(
      with("<lateralProfile><superelevation s='0' a='0.01' b='0'" + rest + "</lateralProfile>")));
  EXPECT_FALSE(IsLevel(
      with("<lateralProfile><shape s='0' t='0' a='0' b='0.01'" + rest + "</lateralProfile>")));
}

/// Compares positions at random places with those that libOpenDRIVE computed
/// (tests/data/road_network/README.md).
void ExpectAsInTable(const std::string& network_file, const std::string& table_file) {
  const std::string source = TRACKBED_SOURCE_DIR;
  const RoadNetwork network = ReadOpenDrive(source + network_file);
  const Table table = ReadCsv(source + table_file);
  ASSERT_EQ(table.rows(), 200U);
  double worst = 0.0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](const char* name) { return table.Column(name)[row]; };
    const Road& road = network.roads.at(std::to_string(static_cast<int>(number("road"))));
    const RoadPosition at =
        LanePositionAt(road, static_cast<int>(number("lane")), number("s_m"), number("offset_m"));
    worst = std::max(worst,
                     std::hypot(at.x - number("x_m"), at.y - number("y_m"), at.z - number("z_m")));
  }
  // The table rounds each of three coordinates to 1e-9 m, and the positions of both libraries are
  // accurate to 1e-9 m.
  EXPECT_LE(worst, Tolerance(2e-9));
}

TEST(Position, IsThatOfAnIndependentReader) {
  ExpectAsInTable("/tests/data/road_network/features.xodr",
                  "/tests/data/road_network/features.csv");
  ExpectAsInTable("/scenarios/roads/crossing.xodr", "/tests/data/road_network/crossing.csv");
}

TEST(Position, OfDrivableLanesFollowsTheTraffic) {
  RoadText left_hand;
  left_hand.attributes = "rule=\"LHT\"";
  EXPECT_TRUE(FollowsRoad(ReadOne({}), -1));
  EXPECT_FALSE(FollowsRoad(ReadOne({}), 1));
  EXPECT_FALSE(FollowsRoad(ReadOne(left_hand), -1));
  EXPECT_TRUE(FollowsRoad(ReadOne(left_hand), 1));
  Lane lane;
  for (const char* type : {"driving", "exit", "onRamp", "bus"}) {
    lane.type = type;
    EXPECT_TRUE(IsDrivable(lane)) << type;
  }
  for (const char* type : {"none", "sidewalk", "shoulder", "parking", "Driving", ""}) {
    lane.type = type;
    EXPECT_FALSE(IsDrivable(lane)) << type;
  }
}

}  // namespace
}  // namespace trackbed

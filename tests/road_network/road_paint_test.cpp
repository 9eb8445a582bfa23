#include "trackbed/road_network/road_paint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/road_network/open_drive.h"

namespace trackbed {
namespace {

// Rounding error [m] of a few operations on coordinates below 100 m.
constexpr double kRoundingOfPaint = 1e-12;

RoadText Marked(const std::string& center_mark) {
  RoadText road;
  const std::string width = "<width sOffset='0' a='3.5' b='0' c='0' d='0'/>";
  road.lanes = "<laneSection s='0'><left><lane id='2' type='sidewalk'>" + width +
               "</lane><lane id='1' type='driving'>" + width +
               "<roadMark sOffset='0' type='solid' color='white' width='0.2'/></lane></left>"
               "<center><lane id='0'>" +
               center_mark + "</lane></center><right><lane id='-1' type='shoulder'>" + width +
               "</lane></right></laneSection>";
  return road;
}

TEST(RoadPaint, PavesWhatIsDrivenOnAndBesideIt) {
  const RoadPaint paint = PaintRoads(ParseNetwork(Marked("").Xml()), 10.0);
  ASSERT_EQ(paint.bands.size(), 1U);
  const PavedBand& band = paint.bands[0];
  ASSERT_EQ(band.left.size(), 11U);
  ASSERT_EQ(band.right.size(), 11U);
  for (std::size_t i = 0; i < band.left.size(); ++i) {
    const double s = 10.0 * static_cast<double>(i);
    EXPECT_NEAR((band.left[i] - Vec2(s, 3.5)).norm(), 0.0, Tolerance(kRoundingOfPaint));
    EXPECT_NEAR((band.right[i] - Vec2(s, -3.5)).norm(), 0.0, Tolerance(kRoundingOfPaint));
  }
  ASSERT_EQ(paint.lines.size(), 1U);
  EXPECT_EQ(paint.lines[0].width, 0.2);
  EXPECT_FALSE(paint.lines[0].yellow);
  EXPECT_NEAR((paint.lines[0].points.back() - Vec2(100.0, 3.5)).norm(), 0.0,
              Tolerance(kRoundingOfPaint));
}

TEST(RoadPaint, CutsBrokenLinesIntoDashes) {
  const RoadPaint paint =
      PaintRoads(ParseNetwork(Marked("<roadMark sOffset='10' type='none'/>"
                                     "<roadMark sOffset='20' type='broken' color='yellow'/>")
                                  .Xml()),
                 1.0);
  // From 20 m to 100 m the center has nine dashes. A dash begins every 9 m, and the last dash
  // begins at 92 m. The tenth line is the solid line.
  ASSERT_EQ(paint.lines.size(), 10U);
  double painted = 0.0;
  for (const PaintedLine& line : paint.lines) {
    if (line.yellow) {
      const double length = (line.points.back() - line.points.front()).norm();
      EXPECT_NEAR(length, 3.0, Tolerance(kRoundingOfPaint));
      EXPECT_GE(line.points.front().x(), 20.0);
      EXPECT_NEAR(line.points.front().y(), 0.0, Tolerance(kRoundingOfPaint));
      painted += length;
    }
  }
  EXPECT_NEAR(painted, 27.0, Tolerance(kRoundingOfPaint));
}

TEST(RoadPaint, DrawsDoubleLinesAsTwo) {
  const RoadPaint paint = PaintRoads(
      ParseNetwork(
          Marked("<roadMark sOffset='0' type='solid broken' color='yellow' width='0.1'/>").Xml()),
      1.0);
  int solid = 0;
  for (const PaintedLine& line : paint.lines) {
    if (line.yellow) {
      const bool is_long = (line.points.back() - line.points.front()).norm() > 50.0;
      solid += is_long ? 1 : 0;
      // Each of the two lines is 0.1 m wide. The gap between them is 0.1 m wide, and the left line
      // is solid.
      EXPECT_NEAR(line.points.front().y(), is_long ? 0.1 : -0.1, Tolerance(kRoundingOfPaint));
    }
  }
  EXPECT_EQ(solid, 1);
}

TEST(RoadPaint, FollowsTheReferenceLine) {
  RoadText road = Marked("");
  road.geometry =
      "<geometry s='0' x='0' y='0' hdg='0' length='100'><arc curvature='0.02'/></geometry>";
  const RoadPaint paint = PaintRoads(ParseNetwork(road.Xml()), 2.0);
  for (const Vec2& point : paint.lines.at(0).points) {
    EXPECT_NEAR((point - Vec2(0.0, 50.0)).norm(), 46.5, Tolerance(kRoundingOfPaint));
  }
}

TEST(RoadPaint, OfAnEndlessNetworkHasFewPoints) {
  RoadText road = Marked("");
  road.length = "1e6";
  road.geometry = "<geometry s='0' x='0' y='0' hdg='0' length='1e6'><line/></geometry>";
  const RoadPaint paint = PaintRoads(ParseNetwork(road.Xml()), 1.0);
  EXPECT_LT(paint.lines[0].points.size() + paint.bands[0].left.size(), 100000U);
  EXPECT_THROW(PaintRoads(RoadNetwork{}, 0.0), InternalError);
}

}  // namespace
}  // namespace trackbed

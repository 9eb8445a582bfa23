#include "trackbed/road_network/lane_paint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

// The paint of lanes between two bounds.
namespace trackbed {
namespace {

const std::vector<Vec2> kRight{{0.0, 0.0}, {25.0, 0.0}, {60.0, 0.0}};
const std::vector<Vec2> kMiddle{{0.0, 4.0}, {25.0, 4.0}, {60.0, 4.0}};
const std::vector<Vec2> kLeft{{0.0, 8.0}, {25.0, 8.0}, {60.0, 8.0}};

std::vector<Vec2> Backwards(std::vector<Vec2> line) {
  std::reverse(line.begin(), line.end());
  return line;
}

double PaintLength(const PaintedLine& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length += (line.points[i] - line.points[i - 1]).norm();
  }
  return length;
}

// Dashes of 3 m begin every 9 m of the 60 m: at 0, 9, ..., 54 m.
TEST(PaintLanes, BreaksTheBoundOfTwoLanesOfOneDirection) {
  const RoadPaint paint = PaintLanes({{kMiddle, kRight}, {kLeft, kMiddle}});
  EXPECT_EQ(paint.bands.size(), 2U);
  int solid = 0;
  std::vector<double> begins;
  for (const PaintedLine& line : paint.lines) {
    if (line.points.front().y() != 4.0) {
      ++solid;
      EXPECT_EQ(PaintLength(line), 60.0);
      continue;
    }
    begins.push_back(line.points.front().x());
    EXPECT_NEAR(PaintLength(line), 3.0, 1e-12);
  }
  EXPECT_EQ(solid, 2);
  ASSERT_EQ(begins.size(), 7U);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    EXPECT_NEAR(begins[i], 9.0 * static_cast<double>(i), 1e-12);
  }
}

TEST(PaintLanes, DrawsTheBoundOfOncomingLanesOnceAndSolid) {
  const RoadPaint paint = PaintLanes({{kMiddle, kRight}, {Backwards(kMiddle), Backwards(kLeft)}});
  EXPECT_EQ(paint.lines.size(), 3U);
  for (const PaintedLine& line : paint.lines) {
    EXPECT_EQ(PaintLength(line), 60.0);
  }
}

}  // namespace
}  // namespace trackbed

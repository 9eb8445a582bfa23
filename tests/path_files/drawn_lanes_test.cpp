#include "trackbed/path_files/drawn_lanes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

// Lanes that are drawn beside a path.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

/// Straight lanes of 100 m toward +x, 3.5 m wide, whose right bounds are at these y.
DrawnLanes StraightLanes(const std::vector<double>& ys) {
  DrawnLanes lanes;
  for (const double y : ys) {
    lanes.push_back({{{0.0, y + 3.5}, {100.0, y + 3.5}}, {{0.0, y}, {100.0, y}}});
  }
  return lanes;
}

TEST(DrawnLanes, AreReadAsTheyAreWritten) {
  std::mt19937 random(50);
  std::uniform_real_distribution<double> place(-1e6, 1e6);
  DrawnLanes lanes(20);
  for (DrawnLane& lane : lanes) {
    for (unsigned i = 0; i < 2 + random() % 5; ++i) {
      lane.left.emplace_back(place(random), place(random));
      lane.right.emplace_back(place(random), place(random));
    }
  }
  const TempFolder folder;
  const DrawnLanes again = ReadLanesCsv(folder.Write(kLanesCsv, LanesCsv(lanes)));
  ASSERT_EQ(again.size(), lanes.size());
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    EXPECT_EQ(again[i].left, lanes[i].left);
    EXPECT_EQ(again[i].right, lanes[i].right);
  }
}

TEST(DrawnLanes, SayWhatIsWrong) {
  const TempFolder folder;
  const std::string header = "lane,left_x_m,left_y_m,right_x_m,right_y_m\n";
  const auto error = [&](const std::string& text) {
    return ErrorText([&] { ReadLanesCsv(folder.Write("l.csv", text)); });
  };
  EXPECT_THAT(error("lane,left_x_m\n1,2\n"), HasSubstr("l.csv:1: left_y_m: missing column"));
  EXPECT_THAT(error(header + "0,1,2,3,4\n"), HasSubstr("l.csv:2: lane: a lane of one row"));
  EXPECT_THAT(error(header + "0,1,2,3,4\n0,1,2,nan,4\n"),
              HasSubstr("l.csv:3: right_x_m: 'nan' is no number"));
  EXPECT_THAT(error(header + "0,1,2,3,4\n0,1,2\n"), HasSubstr("3 cells, the header has 5"));
}

// The reader keeps lanes within the reach, and up to 5 m farther.
TEST(DrawnLanes, AreKeptNearAPath) {
  const DrawnLanes lanes = StraightLanes({0.0, 20.0, 26.0, -40.0});
  const DrawnLanes near = LanesNear(lanes, {{50.0, -1.0}, {50.5, -1.0}, {60.0, -1.0}}, 21.0);
  ASSERT_EQ(near.size(), 2U);
  EXPECT_EQ(near[1].right.front().y(), 20.0);
  EXPECT_EQ(LanesNear(lanes, {{130.0, 0.0}}, 24.0).size(), 0U);
}

}  // namespace
}  // namespace trackbed

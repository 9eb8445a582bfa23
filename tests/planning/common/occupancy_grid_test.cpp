#include "trackbed/planning/common/occupancy_grid.h"

#include <gtest/gtest.h>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

TEST(OccupancyGrid, OccupiesWhatIsNearABoxAndNothingElse) {
  Random random(1);
  const Pose2 frame{3.0, -2.0, 0.4};
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 8; ++i) {
    boxes.push_back(
        {{random.Uniform(-12.0, 12.0), random.Uniform(-12.0, 12.0), random.Uniform(-3.0, 3.0)},
         random.Uniform(0.2, 5.0),
         random.Uniform(0.2, 5.0)});
  }
  const OccupancyGrid grid = Rasterize(frame, {{-15.0, -13.0}, {14.0, 12.0}}, 0.5, boxes, 0.8);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Vec2 middle = grid.CellCenter(i);
    bool near = false;
    for (const OrientedBox& box : boxes) {
      near = near || Distance(middle, middle, box) <= 0.8;
    }
    ASSERT_EQ(grid.occupied[i] != 0, near) << middle.transpose();
    ASSERT_EQ(grid.CellAt(middle), static_cast<int>(i));
  }
}

TEST(OccupancyGrid, HasACellInTheMiddleOfItsFrame) {
  const Pose2 frame{7.0, 1.0, 2.0};
  const OccupancyGrid grid = Rasterize(frame, {{-3.3, -1.2}, {4.1, 2.6}}, 0.5, {}, 0.0);
  const int cell = grid.CellAt(frame.position());
  ASSERT_GE(cell, 0);
  // The tolerance allows for rounding of coordinates of a few meters.
  EXPECT_NEAR((grid.CellCenter(static_cast<std::size_t>(cell)) - frame.position()).norm(), 0.0,
              Tolerance(1e-14));
  EXPECT_EQ(grid.columns, 7 + 9 + 1);
  EXPECT_EQ(grid.rows, 3 + 6 + 1);
  EXPECT_EQ(grid.CellAt(ToWorld(frame, {4.8, 0.0})), -1);
  EXPECT_EQ(grid.CellAt(ToWorld(frame, {0.0, -1.8})), -1);
}

TEST(OccupancyGrid, IsLaidAroundEverything) {
  const Pose2 frame{0.0, 0.0, 0.0};
  const GridArea area =
      AreaAround(frame, {{1.0, 2.0}, {-4.0, 0.0}}, {{{10.0, 0.0, 0.0}, 2.0, 6.0}}, 5.0);
  EXPECT_NEAR((area.low - Vec2(-9.0, -8.0)).norm(), 0.0, Tolerance(1e-14));
  EXPECT_NEAR((area.high - Vec2(16.0, 8.0)).norm(), 0.0, Tolerance(1e-14));
  EXPECT_EQ(CellsIn(area, 1.0), 26.0 * 17.0);
  EXPECT_THROW(Rasterize(frame, {{0.0, 0.0}, {1e6, 1e6}}, 0.1, {}, 0.0), InternalError);
}

}  // namespace
}  // namespace trackbed

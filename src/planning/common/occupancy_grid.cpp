#include "trackbed/planning/common/occupancy_grid.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns column and row of the first cell of an area's grid, counted from the origin of the
/// frame.
Vec2 FirstCell(const GridArea& area, double cell) {
  return {std::floor(area.low.x() / cell), std::floor(area.low.y() / cell)};
}

/// Returns the numbers of columns and rows of an area's grid.
Vec2 CellCounts(const GridArea& area, double cell) {
  const Vec2 last{std::ceil(area.high.x() / cell), std::ceil(area.high.y() / cell)};
  return last - FirstCell(area, cell) + Vec2::Ones();
}

}  // namespace

Vec2 OccupancyGrid::CellCenter(std::size_t index) const {
  const auto width = static_cast<std::size_t>(columns);
  const std::size_t row = index / width;
  return ToWorld(X_WG,
                 {cell * static_cast<double>(index % width), cell * static_cast<double>(row)});
}

int OccupancyGrid::CellAt(const Vec2& point_W) const {
  const Vec2 local = ToLocal(X_WG, point_W) / cell;
  const double column = std::round(local.x());
  const double row = std::round(local.y());
  const bool inside = column >= 0.0 && column < columns && row >= 0.0 && row < rows;
  return inside ? static_cast<int>(row) * columns + static_cast<int>(column) : -1;
}

GridArea AreaAround(const Pose2& X_WF, const std::vector<Vec2>& points_W,
                    const std::vector<OrientedBox>& boxes_W, double margin) {
  TRACKBED_CHECK(!points_W.empty(), "no point to be around");
  const Vec2 first = ToLocal(X_WF, points_W.front());
  GridArea area{first, first};
  const auto include = [&](const Vec2& point_W) {
    const Vec2 local = ToLocal(X_WF, point_W);
    area.low = area.low.cwiseMin(local);
    area.high = area.high.cwiseMax(local);
  };
  std::for_each(points_W.begin(), points_W.end(), include);
  for (const OrientedBox& box : boxes_W) {
    for (const Vec2& corner : box.Corners()) {
      include(corner);
    }
  }
  return {area.low - Vec2::Constant(margin), area.high + Vec2::Constant(margin)};
}

double CellsIn(const GridArea& area, double cell) {
  return CellCounts(area, cell).prod();
}

OccupancyGrid Rasterize(const Pose2& X_WF, const GridArea& area, double cell,
                        const std::vector<OrientedBox>& boxes_W, const Inflation& inflation_of) {
  TRACKBED_CHECK(cell > 0.0 && inflation_of.most >= 0.0, "cells of {} m, inflation {} m", cell,
                 inflation_of.most);
  const Vec2 first = FirstCell(area, cell);
  const Vec2 count = CellCounts(area, cell);
  TRACKBED_CHECK(count.minCoeff() >= 1.0 && count.prod() <= kMaxCells, "{} x {} cells", count.x(),
                 count.y());
  OccupancyGrid grid;
  const Vec2 corner = ToWorld(X_WF, cell * first);
  grid.X_WG = {corner.x(), corner.y(), X_WF.yaw};
  grid.cell = cell;
  grid.columns = static_cast<int>(count.x());
  grid.rows = static_cast<int>(count.y());
  grid.occupied.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
                       0);
  for (std::size_t i = 0; i < boxes_W.size(); ++i) {
    const OrientedBox& box = boxes_W[i];
    const double inflation = inflation_of.From(i);
    TRACKBED_REQUIRE(box.center.position().allFinite() && std::isfinite(box.center.yaw) &&
                         std::isfinite(box.length) && std::isfinite(box.width),
                     "Rasterize: a box of {} x {} m at {}, {}, yaw {}; must be finite", box.length,
                     box.width, box.center.x, box.center.y, box.center.yaw);
    const Vec2 middle = ToLocal(grid.X_WG, box.center.position());
    const double turn = box.center.yaw - X_WF.yaw;
    const Vec2 along = Direction(turn);
    const Vec2 half{0.5 * box.length, 0.5 * box.width};
    const Vec2 reach{std::abs(along.x()) * half.x() + std::abs(along.y()) * half.y() + inflation,
                     std::abs(along.y()) * half.x() + std::abs(along.x()) * half.y() + inflation};
    const auto from = [&](int axis, int most) {
      return static_cast<int>(
          std::clamp(std::ceil((middle[axis] - reach[axis]) / cell), 0.0, 1.0 * most));
    };
    const auto to = [&](int axis, int most) {
      return static_cast<int>(
          std::clamp(std::floor((middle[axis] + reach[axis]) / cell), -1.0, most - 1.0));
    };
    for (int row = from(1, grid.rows); row <= to(1, grid.rows); ++row) {
      for (int column = from(0, grid.columns); column <= to(0, grid.columns); ++column) {
        const Vec2 offset = Vec2{cell * column, cell * row} - middle;
        const double x = std::max(std::abs(along.dot(offset)) - half.x(), 0.0);
        const double y = std::max(std::abs(Cross(along, offset)) - half.y(), 0.0);
        if (x * x + y * y <= inflation * inflation) {
          grid.occupied[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                        static_cast<std::size_t>(column)] = 1;
        }
      }
    }
  }
  return grid;
}

}  // namespace trackbed

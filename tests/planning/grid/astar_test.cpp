#include "trackbed/planning/grid/astar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

OccupancyGrid Clutter(Random& random, int columns, int rows, double share) {
  OccupancyGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  for (int i = 0; i < columns * rows; ++i) {
    grid.occupied.push_back(random.Uniform(0.0, 1.0) < share ? 1 : 0);
  }
  return grid;
}

/// Returns a map drawn as lines of characters, with the top line first; '#' is an occupied cell.
OccupancyGrid Drawn(const std::vector<std::string>& lines) {
  OccupancyGrid grid;
  grid.columns = static_cast<int>(lines[0].size());
  grid.rows = static_cast<int>(lines.size());
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    for (const char c : *line) {
      grid.occupied.push_back(c == '#' ? 1 : 0);
    }
  }
  return grid;
}

/// Returns the costs from `start` to all cells. Relaxes every edge until no cost changes, without a
/// queue or a heuristic.
std::vector<double> BruteForce(const OccupancyGrid& grid, std::size_t start) {
  std::vector<double> cost(grid.size(), kInfinity);
  cost[start] = 0.0;
  const auto free = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < grid.columns && y < grid.rows &&
           grid.occupied[static_cast<std::size_t>(y * grid.columns + x)] == 0;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < grid.rows; ++y) {
      for (int x = 0; x < grid.columns; ++x) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (!free(x, y) || !free(x + dx, y) || !free(x, y + dy) || !free(x + dx, y + dy)) {
              continue;
            }
            const double through = cost[static_cast<std::size_t>(y * grid.columns + x)] +
                                   std::sqrt(static_cast<double>(dx * dx + dy * dy));
            double& there = cost[static_cast<std::size_t>((y + dy) * grid.columns + x + dx)];
            if (through < there - 1e-9) {
              there = through;
              changed = true;
            }
          }
        }
      }
    }
  }
  return cost;
}

TEST(AStar, CostsWhatBruteForceFinds) {
  Random random(1);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const OccupancyGrid grid =
        Clutter(random, 20 + random.Below(21), 20 + random.Below(21), random.Uniform(0.0, 0.45));
    const auto start = static_cast<std::size_t>(random.Below(static_cast<int>(grid.size())));
    const auto goal = static_cast<std::size_t>(random.Below(static_cast<int>(grid.size())));
    const GridPath path = SearchGrid(grid, start, goal);
    if (grid.occupied[start] != 0) {
      EXPECT_EQ(path.status, GridStatus::kStartOccupied);
    } else if (grid.occupied[goal] != 0) {
      EXPECT_EQ(path.status, GridStatus::kGoalOccupied);
    } else {
      const std::vector<double> cost = BruteForce(grid, start);
      ASSERT_EQ(path.ok(), cost[goal] < kInfinity);
      if (path.ok()) {
        ++found;
        // The tolerance allows for sums of at most 1600 steps in another order. BruteForce stops
        // relaxing at changes of 1e-9.
        ASSERT_NEAR(path.cost, cost[goal], Tolerance(2e-9));
        ASSERT_NEAR(DistancesTo(grid, goal)[start], cost[goal], Tolerance(2e-9));
      }
    }
  }
  EXPECT_GT(found, 80);
}

TEST(AStar, SeesAtOnceThatAnEndIsInAPocket) {
  const OccupancyGrid grid = Drawn({"............",  //
                                    "............",  //
                                    "..###.......",  //
                                    "..#.#.......",  //
                                    "..#.#.......",  //
                                    "..###.......",  //
                                    "............",  //
                                    "............"});
  const std::size_t inside = 3 * 12 + 3;
  for (const auto& [start, goal] : {std::pair{inside, std::size_t{0}}, {std::size_t{0}, inside}}) {
    const GridPath path = SearchGrid(grid, start, goal);
    EXPECT_EQ(path.status, GridStatus::kUnreachable);
    EXPECT_EQ(path.expansions, 2);
    EXPECT_EQ(SearchGrid(grid, start, goal, 1).status, GridStatus::kBudgetUsedUp);
  }
  EXPECT_TRUE(SearchGrid(grid, inside, inside + 12).ok());
  EXPECT_TRUE(SearchGrid(grid, inside, inside).ok());
}

TEST(AStar, WalksFromCellToNeighborAndCutsNoCorner) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    OccupancyGrid grid = Clutter(random, 40, 30, 0.25);
    grid.occupied.front() = 0;
    grid.occupied.back() = 0;
    const GridPath path = SearchGrid(grid, 0, grid.size() - 1);
    if (!path.ok()) {
      continue;
    }
    EXPECT_EQ(path.cells.front(), 0U);
    EXPECT_EQ(path.cells.back(), grid.size() - 1);
    double cost = 0.0;
    for (std::size_t k = 1; k < path.cells.size(); ++k) {
      const int a = static_cast<int>(path.cells[k - 1]);
      const int b = static_cast<int>(path.cells[k]);
      const int dx = b % 40 - a % 40;
      const int dy = b / 40 - a / 40;
      ASSERT_LE(std::max(std::abs(dx), std::abs(dy)), 1);
      ASSERT_EQ(grid.occupied[static_cast<std::size_t>(b)], 0);
      ASSERT_EQ(grid.occupied[static_cast<std::size_t>(a + dx)], 0);
      ASSERT_EQ(grid.occupied[static_cast<std::size_t>(a + 40 * dy)], 0);
      cost += std::hypot(dx, dy);
    }
    EXPECT_NEAR(cost, path.cost, Tolerance(1e-12) * static_cast<double>(path.cells.size()));
  }
}

TEST(AStar, HasAnAdmissibleAndConsistentHeuristic) {
  // On an empty grid, the heuristic equals the cost. Obstacles can only increase the cost.
  OccupancyGrid grid;
  grid.columns = 41;
  grid.rows = 31;
  grid.occupied.assign(41 * 31, 0);
  const std::vector<double> cost = BruteForce(grid, 15 * 41 + 20);
  for (int y = 0; y < 31; ++y) {
    for (int x = 0; x < 41; ++x) {
      const double h = OctileDistance(x - 20, y - 15);
      EXPECT_NEAR(h, cost[static_cast<std::size_t>(y * 41 + x)], Tolerance(1e-9));
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        const double step = std::hypot(dx, dy);
        EXPECT_LE(std::abs(h - OctileDistance(x + dx - 20, y + dy - 15)), step + 1e-12);
      }
    }
  }
}

TEST(AStar, LooksAtNoMoreThanItMust) {
  OccupancyGrid grid;
  grid.columns = 200;
  grid.rows = 200;
  grid.occupied.assign(200 * 200, 0);
  // On a straight line across an empty map, the heuristic equals the cost, so the search expands
  // only the cells of the path.
  const GridPath path = SearchGrid(grid, 0, grid.size() - 1);
  EXPECT_NEAR(path.cost, 199.0 * std::numbers::sqrt2, Tolerance(1e-9));
  EXPECT_LE(path.expansions, 200);
}

TEST(AStar, SaysWhyThereIsNoWay) {
  const OccupancyGrid walled = Drawn({"..#..",  //
                                      ".#...",  //
                                      "#...."});
  EXPECT_EQ(SearchGrid(walled, 1, 14).status, GridStatus::kFound);
  EXPECT_EQ(SearchGrid(walled, 1, 10).status, GridStatus::kUnreachable);  // The way cuts corners.
  EXPECT_EQ(SearchGrid(walled, 0, 14).status, GridStatus::kStartOccupied);
  EXPECT_EQ(SearchGrid(walled, 14, 0).status, GridStatus::kGoalOccupied);
  EXPECT_EQ(SearchGrid(walled, 1, 14, 0).status, GridStatus::kBudgetUsedUp);
  EXPECT_EQ(SearchGrid(walled, 1, 14, 2).status, GridStatus::kBudgetUsedUp);
  EXPECT_EQ(SearchGrid(walled, 1, 1).cost, 0.0);
  EXPECT_EQ(SearchGrid(walled, 1, 1).cells.size(), 1U);
  EXPECT_THROW(SearchGrid(walled, 15, 0), InternalError);
}

// --- Two drawbacks: A* ignores the car's limits, and small changes flip its result ---------------

TEST(AStar, JumpsInHeadingByAnEighthOfATurn) {
  const OccupancyGrid grid = Drawn({"..........",  //
                                    "..........",  //
                                    ".....#....",  //
                                    ".....#....",  //
                                    ".....#...."});
  const GridPath path = SearchGrid(grid, 0, 9);
  ASSERT_TRUE(path.ok());
  double sharpest = 0.0;
  for (std::size_t k = 2; k < path.cells.size(); ++k) {
    const auto point = [&](std::size_t i) {
      return Vec2{static_cast<double>(path.cells[i] % 10), static_cast<double>(path.cells[i] / 10)};
    };
    const Vec2 in = point(k - 1) - point(k - 2);
    const Vec2 out = point(k) - point(k - 1);
    const double turn = std::abs(std::atan2(Cross(in, out), in.dot(out)));
    // The path turns by 0 or 45 degrees at a single point. A path of finite curvature cannot turn
    // at a point.
    EXPECT_TRUE(turn < 1e-12 || std::abs(turn - 0.25 * kPi) < 1e-12) << turn;
    sharpest = std::max(sharpest, turn);
  }
  EXPECT_NEAR(sharpest, 0.25 * kPi, Tolerance(1e-12));
}

TEST(AStar, GoesRoundTheOtherSideForASmallShift) {
  // A box 5 m long stands on the straight line. The path passes the box on the side on which the
  // box extends less far from the line. A small shift of the box or the start changes the side.
  const auto side = [](double box_y, double start_y) {
    const OccupancyGrid grid = Rasterize({0.0, 0.0, 0.0}, {{-2.0, -10.0}, {32.0, 10.0}}, 0.5,
                                         {{{15.0, box_y, 0.0}, 5.0, 5.0}}, 1.0);
    const GridPath path = SearchGrid(grid, static_cast<std::size_t>(grid.CellAt({0.0, start_y})),
                                     static_cast<std::size_t>(grid.CellAt({30.0, 0.0})));
    for (const std::size_t cell : path.cells) {
      const Vec2 middle = grid.CellCenter(cell);
      if (std::abs(middle.x() - 15.0) < 0.25) {
        return middle.y() > box_y ? 1 : -1;
      }
    }
    return 0;
  };
  EXPECT_EQ(side(-0.3, 0.0), 1);
  EXPECT_EQ(side(0.3, 0.0), -1);  // The box is shifted 0.6 m to the left.
  EXPECT_EQ(side(0.0, 0.5), 1);
  EXPECT_EQ(side(0.0, -0.5), -1);  // The start is shifted 1 m to the right.
}

}  // namespace
}  // namespace trackbed

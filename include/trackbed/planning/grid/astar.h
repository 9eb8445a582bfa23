#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trackbed/planning/common/occupancy_grid.h"

/// A* (Hart et al. 1968) on a grid with eight neighbors, the baseline of the other planners: it
/// ignores the heading and the turning circle of a car.
///
/// Symbols: g(n) cost of the best known path to cell n, h(n) octile distance from n to the goal,
/// both in cells: 1 straight, sqrt(2) diagonally. Diagonal moves need both adjacent cells free.
namespace trackbed {

/// max(|dx|, |dy|) + (sqrt(2) - 1) min(|dx|, |dy|): the cost of a path without obstacles. Never
/// above the true cost (admissible), and h(m) <= c(m, n) + h(n) for neighbors (consistent).
double OctileDistance(int dx, int dy);

enum class GridStatus {
  kFound,
  kStartOccupied,
  kGoalOccupied,
  kUnreachable,   ///< all reachable cells have been expanded
  kBudgetUsedUp,  ///< before the goal was reached
};

/// "found", "start_occupied", …: the spelling of plan.json.
const char* ToString(GridStatus status);

struct GridPath {
  GridStatus status = GridStatus::kUnreachable;
  std::vector<std::size_t> cells;  ///< start to goal, each adjacent to the next; empty unless found
  double cost = std::numeric_limits<double>::infinity();  ///< [cells]
  long expansions = 0;                                    ///< expanded cells

  [[nodiscard]] bool ok() const { return status == GridStatus::kFound; }
};

/// The cheapest path between two cells of the grid (InternalError for other cells), expanding at
/// most `budget` cells. Cost: some 30 ns per expanded cell.
GridPath SearchGrid(const OccupancyGrid& grid, std::size_t start, std::size_t goal,
                    long budget = std::numeric_limits<long>::max());

/// The cost from every cell to `goal`, by Dijkstra's algorithm; infinite if there is no path.
std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal);

}  // namespace trackbed

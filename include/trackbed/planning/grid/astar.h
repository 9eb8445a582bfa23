#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trackbed/planning/common/occupancy_grid.h"

/// A* (Hart et al. 1968) on a grid with eight neighbors, the baseline of the other planners: it
/// ignores that a car has a heading and a turning circle.
///
/// Symbols: g(n) cost of the best way known to cell n, h(n) octile distance from n to the goal,
/// both in cells: 1 straight, sqrt(2) across. A step across needs both cells beside it to be free.
namespace trackbed {

/// max(|dx|, |dy|) + (sqrt(2) - 1) min(|dx|, |dy|): the cost of a path without obstacles. Never
/// above the true cost (admissible), and h(m) <= c(m, n) + h(n) for neighbors (consistent).
double OctileDistance(int dx, int dy);

enum class GridStatus {
  kFound,
  kStartOccupied,
  kGoalOccupied,
  kUnreachable,   ///< every cell that can be reached has been looked at
  kBudgetUsedUp,  ///< before the goal was reached
};

/// "found", "start_occupied", …: the spelling of plan.json.
const char* ToString(GridStatus status);

struct GridPath {
  GridStatus status = GridStatus::kUnreachable;
  std::vector<std::size_t> cells;  ///< start to goal, each beside the next; empty unless found
  double cost = std::numeric_limits<double>::infinity();  ///< [cells]
  long expansions = 0;                                    ///< cells whose neighbors were looked at

  [[nodiscard]] bool ok() const { return status == GridStatus::kFound; }
};

/// The cheapest path between two cells of the grid (InternalError for others), looking at no more
/// than `budget` cells. Cost: some 30 ns a cell, of those that h does not rule out.
GridPath SearchGrid(const OccupancyGrid& grid, std::size_t start, std::size_t goal,
                    long budget = std::numeric_limits<long>::max());

/// The cost from every cell to `goal`, by Dijkstra's algorithm; infinite where there is no way.
std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal);

}  // namespace trackbed

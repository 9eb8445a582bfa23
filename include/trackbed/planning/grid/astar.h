#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trackbed/planning/common/occupancy_grid.h"

/// A* (Hart et al. 1968) on a grid with eight neighbors: the baseline for comparing planners. The
/// search ignores the heading and the turning circle of a car.
///
/// Symbols: g(n) cost of the best known path to cell n, h(n) octile distance from n to the goal,
/// both in cells. A straight move costs 1, a diagonal one sqrt(2). A diagonal move is allowed only
/// if both cells beside it are free.
namespace trackbed {

/// Returns the cost of the cheapest path over `dx` columns and `dy` rows without obstacles:
/// max(|dx|, |dy|) + (sqrt(2) - 1) min(|dx|, |dy|). The octile distance never exceeds the true cost
/// (admissible), and h(m) <= c(m, n) + h(n) for neighbors m, n (consistent).
double OctileDistance(int dx, int dy);

enum class GridStatus {
  kFound,
  kStartOccupied,
  kGoalOccupied,
  kUnreachable,   ///< The search expanded all reachable cells without reaching the goal.
  kBudgetUsedUp,  ///< The search used up its budget before it reached the goal.
};

/// Returns the spelling of a status in plan.json: "found", "start_occupied", ….
const char* ToString(GridStatus status);

struct GridPath {
  GridStatus status = GridStatus::kUnreachable;
  /// Adjacent cells from start to goal; empty unless found.
  std::vector<std::size_t> cells;
  double cost = std::numeric_limits<double>::infinity();  ///< Cost of the path [cells].
  long expansions = 0;                                    ///< Number of expanded cells.

  [[nodiscard]] bool ok() const { return status == GridStatus::kFound; }
};

/// Finds the cheapest path between two cells of the grid, expanding at most `budget` cells. Throws
/// InternalError for cells outside of the grid. Cost: 30 ns per expanded cell.
GridPath SearchGrid(const OccupancyGrid& grid, std::size_t start, std::size_t goal,
                    long budget = std::numeric_limits<long>::max());

/// Computes the cost from every cell to `goal` by Dijkstra's algorithm. The cost is infinite if
/// there is no path.
std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal);

}  // namespace trackbed

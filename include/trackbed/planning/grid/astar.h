#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trackbed/planning/common/occupancy_grid.h"

/// Searches for paths by A* (Hart et al. 1968) on a grid in which each cell has eight neighbors;
/// serves as the baseline for comparing planners. The search by A* ignores the car's heading and
/// turning circle.
///
/// Symbols: g(n) is the cost of the best known path to cell n, and h(n) the octile distance from n
/// to the goal, both in cells. A straight move to a neighboring cell costs 1, a diagonal move
/// sqrt(2). A diagonal move is allowed only if the two cells beside the move are free.
namespace trackbed {

/// Returns the octile distance, which is the cost of the cheapest path over `dx` columns and `dy`
/// rows without obstacles: max(|dx|, |dy|) + (sqrt(2) - 1) min(|dx|, |dy|). The octile distance
/// never exceeds the true cost of a path to the goal (admissible). For neighboring cells m and n
/// with the cost c(m, n) of a move, the octile distance h meets h(m) <= c(m, n) + h(n)
/// (consistent).
double OctileDistance(int dx, int dy);

enum class GridStatus {
  kFound,
  kStartOccupied,
  kGoalOccupied,
  kUnreachable,   ///< The search has expanded all reachable cells, and the goal is not among them.
  kBudgetUsedUp,  ///< The search used up its budget before it reached the goal.
};

/// Returns the name of a status as written in plan.json: "found", "start_occupied", ….
const char* ToString(GridStatus status);

struct GridPath {
  GridStatus status = GridStatus::kUnreachable;
  /// Indices of the path's cells from start to goal; empty unless a path was found.
  std::vector<std::size_t> cells;
  /// Cost of the found path, in side lengths of a cell.
  double cost = std::numeric_limits<double>::infinity();
  long expansions = 0;  ///< Number of cells that the search expanded.

  [[nodiscard]] bool ok() const { return status == GridStatus::kFound; }
};

/// Finds the cheapest path between two cells of the grid, expanding at most `budget` cells. Throws
/// InternalError if a cell is outside of the grid. Computing time: 30 ns per expanded cell.
GridPath SearchGrid(const OccupancyGrid& grid, std::size_t start, std::size_t goal,
                    long budget = std::numeric_limits<long>::max());

/// Computes the cost from every cell to `goal` by Dijkstra's algorithm. The cost of a cell without
/// a path to `goal` is infinite.
std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal);

}  // namespace trackbed

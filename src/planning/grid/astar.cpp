#include "trackbed/planning/grid/astar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "trackbed/core/error.h"

// Implements A* (Hart et al. 1968) on a grid in which each cell has eight neighbors. The grid is
// surrounded by occupied cells, so that steps to neighbors need no bounds check. Open cells are
// kept in a bucket queue, whose key is the excess of g + h over h(start); a bucket is half a
// straight step wide. The search ends when no remaining bucket can improve the goal's cost. Before
// the search, PocketSize detects whether the start or the goal is enclosed in a pocket of at most
// 64 cells. The function DistancesTo runs Dijkstra's algorithm with the same bucket queue.

namespace trackbed {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Cost stored for occupied cells. The cost of occupied cells is lower than the cost of any path,
/// so no path to an occupied cell is an improvement and the search never enters one.
constexpr double kOccupied = -kNever;

struct Step {
  int dx;
  int dy;
};

constexpr std::array<Step, 8> kSteps{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// Cost of the best known path to each cell, on a grid with a border of occupied cells. Because of
/// this border, steps to neighbors need no bounds check.
struct Costs {
  explicit Costs(const OccupancyGrid& grid)
      : width(grid.columns + 2),
        cost(static_cast<std::size_t>(width) * static_cast<std::size_t>(grid.rows + 2), kOccupied),
        columns(grid.columns) {
    for (int row = 0; row < grid.rows; ++row) {
      const auto from = grid.occupied.begin() + static_cast<std::ptrdiff_t>(row) * grid.columns;
      std::transform(from, from + grid.columns,
                     cost.begin() + static_cast<std::ptrdiff_t>(row + 1) * width + 1,
                     [](std::uint8_t occupied) { return occupied != 0 ? kOccupied : kNever; });
    }
    for (std::size_t i = 0; i < kSteps.size(); ++i) {
      offset[i] = kSteps[i].dy * width + kSteps[i].dx;
    }
  }

  [[nodiscard]] int Inside(std::size_t index) const {
    const int i = static_cast<int>(index);
    return (i / columns + 1) * width + i % columns + 1;
  }
  [[nodiscard]] std::size_t Outside(int index) const {
    return static_cast<std::size_t>((index / width - 1) * columns + index % width - 1);
  }
  double& operator[](int index) { return cost[static_cast<std::size_t>(index)]; }

  int width;
  std::vector<double> cost;
  std::array<int, 8> offset{};

 private:
  int columns;
};

/// Priority queue of buckets in ascending order of their keys. Within a bucket, the queue returns
/// the newest entry first. Except for rounding errors, no new key is below the range of the current
/// bucket.
class Buckets {
 public:
  struct Entry {
    // Column of the cell in the bordered grid; stored to save two divisions per cost estimate.
    int x;
    int y;
    double cost;
  };

  /// Width of a bucket, in units of a straight step. With buckets of this width, the search expands
  /// only few cells twice.
  static constexpr double kWidth = 0.5;

  void Push(double key, const Entry& entry) {
    const auto bucket = std::max(now_, static_cast<std::size_t>(key / kWidth));
    if (bucket >= buckets_.size()) {
      buckets_.resize(bucket + 1 + bucket / 2);
    }
    buckets_[bucket].push_back(entry);
  }

  /// Removes the next entry from the queue. After each bucket, calls `done` with the lower bound of
  /// the remaining keys. Returns false if the queue is empty or if `done` returns true.
  template <typename Done>
  bool Pop(Entry& entry, const Done& done) {
    while (now_ < buckets_.size() && buckets_[now_].empty()) {
      std::vector<Entry>().swap(buckets_[now_]);
      ++now_;
      if (done(kWidth * static_cast<double>(now_))) {
        return false;
      }
    }
    if (now_ == buckets_.size()) {
      return false;
    }
    entry = buckets_[now_].back();
    buckets_[now_].pop_back();
    return true;
  }

 private:
  std::vector<std::vector<Entry>> buckets_;
  std::size_t now_ = 0;
};

/// Largest number of cells in a pocket.
constexpr std::size_t kPocket = 64;

/// Returns the number of cells that are reachable from `cell`, or 0 if `other` is reachable or more
/// than kPocket cells are reachable. PocketSize takes only microseconds and detects an enclosed
/// start or goal. Without this check for an enclosed goal, the search could expand all other cells
/// before finding that the goal is unreachable.
std::size_t PocketSize(const OccupancyGrid& grid, std::size_t cell, std::size_t other) {
  const auto free = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < grid.columns && y < grid.rows &&
           grid.occupied[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns) +
                         static_cast<std::size_t>(x)] == 0;
  };
  const auto columns = static_cast<std::size_t>(grid.columns);
  std::vector<std::size_t> reached{cell};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto x = static_cast<int>(reached[i] % columns);
    const auto y = static_cast<int>(reached[i] / columns);
    // Orthogonal moves are sufficient to reach all reachable cells, because a diagonal move
    // requires that both orthogonal neighbors are free.
    for (const auto& [dx, dy] : {kSteps[0], kSteps[1], kSteps[2], kSteps[3]}) {
      if (!free(x + dx, y + dy)) {
        continue;
      }
      const std::size_t next =
          static_cast<std::size_t>(y + dy) * columns + static_cast<std::size_t>(x + dx);
      if (next == other) {
        return 0;
      }
      if (std::find(reached.begin(), reached.end(), next) == reached.end()) {
        if (reached.size() == kPocket) {
          return 0;
        }
        reached.push_back(next);
      }
    }
  }
  return reached.size();
}

/// Updates the cost of every neighbor that a path through `cell` reaches at a lower cost. `cost` is
/// the cost of `cell`. For each updated neighbor, calls `take` with the neighbor, the number of
/// the step and the new cost.
template <typename Take>
void ForEachBetter(Costs& costs, int cell, double cost, const Take& take) {
  const auto offer = [&](std::size_t i, double through) {
    double& best = costs[cell + costs.offset[i]];
    const bool free = best != kOccupied;
    if (through < best) {
      best = through;
      take(cell + costs.offset[i], i, through);
    }
    return free;
  };
  std::array<bool, 4> free{};
  for (std::size_t i = 0; i < 4; ++i) {
    free[i] = offer(i, cost + 1.0);
  }
  for (std::size_t i = 4; i < 8; ++i) {
    if (free[kSteps[i].dx > 0 ? 0 : 1] && free[kSteps[i].dy > 0 ? 2 : 3]) {
      offer(i, cost + std::numbers::sqrt2);
    }
  }
}

}  // namespace

double OctileDistance(int dx, int dy) {
  const int x = std::abs(dx);
  const int y = std::abs(dy);
  return std::max(x, y) + (std::numbers::sqrt2 - 1.0) * std::min(x, y);
}

const char* ToString(GridStatus status) {
  switch (status) {
    case GridStatus::kFound:
      return "found";
    case GridStatus::kStartOccupied:
      return "start_occupied";
    case GridStatus::kGoalOccupied:
      return "goal_occupied";
    case GridStatus::kUnreachable:
      return "unreachable";
    case GridStatus::kBudgetUsedUp:
      return "budget_used_up";
  }
  return "";
}

GridPath SearchGrid(const OccupancyGrid& grid, std::size_t start, std::size_t goal, long budget) {
  TRACKBED_CHECK(start < grid.size() && goal < grid.size(), "cells {} and {} of {}", start, goal,
                 grid.size());
  GridPath result;
  if (grid.occupied[start] != 0 || grid.occupied[goal] != 0) {
    result.status =
        grid.occupied[start] != 0 ? GridStatus::kStartOccupied : GridStatus::kGoalOccupied;
    return result;
  }
  for (const auto& [cell, other] : {std::pair(start, goal), std::pair(goal, start)}) {
    const auto pocket = start == goal ? 0L : static_cast<long>(PocketSize(grid, cell, other));
    if (pocket > 0 && pocket <= budget) {
      result.expansions = pocket;
      return result;
    }
  }
  Costs costs(grid);
  const int from = costs.Inside(start);
  const int to = costs.Inside(goal);
  const int goal_x = to % costs.width;
  const int goal_y = to / costs.width;
  const auto heuristic = [&](int x, int y) { return OctileDistance(x - goal_x, y - goal_y); };
  std::vector<std::uint8_t> came_by(costs.cost.size(), 0);
  const int start_x = from % costs.width;
  const int start_y = from / costs.width;
  const double least = heuristic(start_x, start_y);
  Buckets open;
  costs[from] = 0.0;
  open.Push(0.0, {start_x, start_y, 0.0});
  const double& goal_cost = costs[to];
  const auto found = [&](double keys_left) { return goal_cost - least < keys_left; };
  for (Buckets::Entry at{}; open.Pop(at, found);) {
    const int here = at.y * costs.width + at.x;
    if (at.cost > costs[here] || at.cost >= goal_cost) {
      continue;  // the search has since found a better path to this cell, or to the goal
    }
    if (result.expansions >= budget) {
      result.status = GridStatus::kBudgetUsedUp;
      return result;
    }
    ++result.expansions;
    ForEachBetter(costs, here, at.cost, [&](int cell, std::size_t step, double through) {
      came_by[static_cast<std::size_t>(cell)] = static_cast<std::uint8_t>(step);
      const int x = at.x + kSteps[step].dx;
      const int y = at.y + kSteps[step].dy;
      open.Push(through + heuristic(x, y) - least, {x, y, through});
    });
  }
  if (goal_cost == kNever) {
    return result;
  }
  result.status = GridStatus::kFound;
  result.cost = goal_cost;
  for (int cell = to;; cell -= costs.offset[came_by[static_cast<std::size_t>(cell)]]) {
    result.cells.push_back(costs.Outside(cell));
    if (cell == from) {
      break;
    }
  }
  std::reverse(result.cells.begin(), result.cells.end());
  return result;
}

std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal) {
  TRACKBED_CHECK(goal < grid.size(), "cell {} of {}", goal, grid.size());
  Costs costs(grid);
  const int to = costs.Inside(goal);
  Buckets open;
  costs[to] = 0.0;
  open.Push(0.0, {to % costs.width, to / costs.width, 0.0});
  for (Buckets::Entry at{}; open.Pop(at, [](double) { return false; });) {
    const int here = at.y * costs.width + at.x;
    if (at.cost > costs[here]) {
      continue;
    }
    ForEachBetter(costs, here, at.cost, [&](int, std::size_t step, double through) {
      open.Push(through, {at.x + kSteps[step].dx, at.y + kSteps[step].dy, through});
    });
  }
  std::vector<double> distances(grid.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double cost = costs[costs.Inside(i)];
    distances[i] = cost == kOccupied ? kNever : cost;
  }
  return distances;
}

}  // namespace trackbed

#include "trackbed/planning/grid/astar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// The cost of an occupied cell: no way there is ever a better one.
constexpr double kOccupied = -kNever;

struct Step {
  int dx;
  int dy;
};

constexpr std::array<Step, 8> kSteps{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// The cost of the best known way to each cell, of a grid with a border of occupied cells, so that
/// no step needs to look where it is.
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

/// Cells by rising key, a bucket at a time; in a bucket the last one in is the first one out. Keys
/// never fall below the bucket that is being emptied, but for rounding.
class Buckets {
 public:
  struct Entry {
    int x;  // of the bordered grid: without them every estimate would take two divisions
    int y;
    double cost;
  };

  /// Half a straight step: few cells are found better ways to after they were looked at.
  static constexpr double kWidth = 0.5;

  void Push(double key, const Entry& entry) {
    const auto bucket = std::max(now_, static_cast<std::size_t>(key / kWidth));
    if (bucket >= buckets_.size()) {
      buckets_.resize(bucket + 1 + bucket / 2);
    }
    buckets_[bucket].push_back(entry);
  }

  /// The next entry, or none. `done` is asked after every bucket, with the keys that all the rest
  /// are not below.
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

/// A cell from which no more than this many can be reached is in a pocket.
constexpr std::size_t kPocket = 64;

/// How many cells can be reached from one that is in a pocket without the other; else 0. Looked at
/// first: it takes microseconds, and what the search itself sets up takes longer; without it, a
/// goal in a pocket would be found out only when all else has been looked at.
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
    // What is across can be reached, if at all, along what is beside.
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

/// Notes every neighbor to which the way through `cell`, at `cost`, is the best one known, and
/// calls `take` with it, the step's number and the cost.
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
      continue;  // a better way to here, or to the goal, has been found since
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

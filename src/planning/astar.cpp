#include "trackbed/planning/astar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Step {
  int dx;
  int dy;
};

constexpr std::array<Step, 8> kSteps{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// The grid with a border of occupied cells, so that no step needs to look where it is.
struct Bordered {
  explicit Bordered(const OccupancyGrid& grid)
      : width(grid.columns + 2),
        occupied(static_cast<std::size_t>(width) * static_cast<std::size_t>(grid.rows + 2), 1),
        columns(grid.columns) {
    for (int row = 0; row < grid.rows; ++row) {
      const auto from = grid.occupied.begin() + static_cast<std::ptrdiff_t>(row) * grid.columns;
      std::copy(from, from + grid.columns,
                occupied.begin() + static_cast<std::ptrdiff_t>(row + 1) * width + 1);
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
  [[nodiscard]] bool Occupied(int index) const {
    return occupied[static_cast<std::size_t>(index)] != 0;
  }

  int width;
  std::vector<std::uint8_t> occupied;
  std::array<int, 8> offset{};

 private:
  int columns;
};

/// Cells by rising key, a bucket at a time; in a bucket the last one in is the first one out. Keys
/// never fall below the bucket that is being emptied, but for rounding.
class Buckets {
 public:
  struct Entry {
    int cell;
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

/// Calls `take` with each neighbour that can be stepped to, the step's number and its cost.
template <typename Take>
void ForEachNeighbour(const Bordered& grid, int cell, const Take& take) {
  std::array<bool, 4> free{};
  for (std::size_t i = 0; i < 4; ++i) {
    free[i] = !grid.Occupied(cell + grid.offset[i]);
    if (free[i]) {
      take(cell + grid.offset[i], i, 1.0);
    }
  }
  for (std::size_t i = 4; i < 8; ++i) {
    const bool beside = free[kSteps[i].dx > 0 ? 0 : 1] && free[kSteps[i].dy > 0 ? 2 : 3];
    if (beside && !grid.Occupied(cell + grid.offset[i])) {
      take(cell + grid.offset[i], i, std::numbers::sqrt2);
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
  const Bordered bordered(grid);
  const int from = bordered.Inside(start);
  const int to = bordered.Inside(goal);
  const int goal_x = to % bordered.width;
  const int goal_y = to / bordered.width;
  const auto heuristic = [&](int cell) {
    return OctileDistance(cell % bordered.width - goal_x, cell / bordered.width - goal_y);
  };
  std::vector<double> cost(bordered.occupied.size(), kNever);
  std::vector<std::uint8_t> came_by(bordered.occupied.size(), 0);
  const double least = heuristic(from);
  Buckets open;
  cost[static_cast<std::size_t>(from)] = 0.0;
  open.Push(0.0, {from, 0.0});
  const double& goal_cost = cost[static_cast<std::size_t>(to)];
  const auto found = [&](double keys_left) { return goal_cost - least < keys_left; };
  for (Buckets::Entry at{}; open.Pop(at, found);) {
    if (at.cost > cost[static_cast<std::size_t>(at.cell)] || at.cost >= goal_cost) {
      continue;  // a better way to here, or to the goal, has been found since
    }
    if (result.expansions >= budget) {
      result.status = GridStatus::kBudgetUsedUp;
      return result;
    }
    ++result.expansions;
    ForEachNeighbour(bordered, at.cell, [&](int cell, std::size_t step, double length) {
      const double through = at.cost + length;
      double& best = cost[static_cast<std::size_t>(cell)];
      if (through < best) {
        best = through;
        came_by[static_cast<std::size_t>(cell)] = static_cast<std::uint8_t>(step);
        open.Push(through + heuristic(cell) - least, {cell, through});
      }
    });
  }
  if (goal_cost == kNever) {
    return result;
  }
  result.status = GridStatus::kFound;
  result.cost = goal_cost;
  for (int cell = to;; cell -= bordered.offset[came_by[static_cast<std::size_t>(cell)]]) {
    result.cells.push_back(bordered.Outside(cell));
    if (cell == from) {
      break;
    }
  }
  std::reverse(result.cells.begin(), result.cells.end());
  return result;
}

std::vector<double> DistancesTo(const OccupancyGrid& grid, std::size_t goal) {
  TRACKBED_CHECK(goal < grid.size(), "cell {} of {}", goal, grid.size());
  const Bordered bordered(grid);
  const int to = bordered.Inside(goal);
  std::vector<double> cost(bordered.occupied.size(), kNever);
  Buckets open;
  cost[static_cast<std::size_t>(to)] = 0.0;
  open.Push(0.0, {to, 0.0});
  for (Buckets::Entry at{}; open.Pop(at, [](double) { return false; });) {
    if (at.cost > cost[static_cast<std::size_t>(at.cell)]) {
      continue;
    }
    ForEachNeighbour(bordered, at.cell, [&](int cell, std::size_t, double length) {
      const double through = at.cost + length;
      double& best = cost[static_cast<std::size_t>(cell)];
      if (through < best) {
        best = through;
        open.Push(through, {cell, through});
      }
    });
  }
  std::vector<double> distances(grid.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    distances[i] = cost[static_cast<std::size_t>(bordered.Inside(i))];
  }
  return distances;
}

}  // namespace trackbed

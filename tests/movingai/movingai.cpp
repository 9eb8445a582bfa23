#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/grid/astar.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/grid/map_grid.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/moving_ai.h"
#include "trackbed/scenario/moving_ai_instances.h"

/// A* on the maps of the Moving AI benchmarks: compares path lengths with the listed ones and
/// counts the paths that a car can drive (scripts/movingai).
namespace trackbed {
namespace {

/// The square root of 2, rounded as in the path lengths that the benchmark lists. From seven
/// diagonal steps on, this rounding changes the eighth decimal of a path length.
constexpr double kRootTwo = 1.414213562;

/// Whether a path's length equals the listed length to eight decimals, with the exact square root
/// of 2 or with the benchmark's rounded root. A sum of a thousand steps deviates by 1e-12.
bool HasLength(const GridPath& path, int columns, double listed) {
  constexpr double kPrinted = 0.5e-8 + 1e-11;
  double length = 0.0;
  for (std::size_t i = 1; i < path.cells.size(); ++i) {
    const auto step =
        static_cast<std::ptrdiff_t>(path.cells[i]) - static_cast<std::ptrdiff_t>(path.cells[i - 1]);
    const bool is_straight = std::abs(step) == 1 || std::abs(step) == columns;
    length += is_straight ? 1.0 : kRootTwo;
  }
  return path.ok() &&
         (std::abs(path.cost - listed) <= kPrinted || std::abs(length - listed) <= kPrinted);
}

/// Solves every instance, and prints the instances whose path length differs from the listed
/// length.
std::vector<GridPath> Solve(const GridMap& map, const std::vector<MovingAiInstance>& instances,
                            int& wrong) {
  const OccupancyGrid grid = ToOccupancyGrid(map, UnknownCells::kFree);
  const auto cell = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) +
           static_cast<std::size_t>(column);
  };
  std::vector<GridPath> all;
  for (const MovingAiInstance& instance : instances) {
    if (instance.columns != map.columns || instance.rows != map.rows) {
      throw InputError(
          Problem{.line = instance.line,
                  .message = fmt::format("an instance on {} x {} cells, a map of {} x {}",
                                         instance.columns, instance.rows, map.columns, map.rows)});
    }
    all.push_back(SearchGrid(grid, cell(instance.start_column, instance.start_row),
                             cell(instance.goal_column, instance.goal_row)));
    const GridPath& path = all.back();
    if (!HasLength(path, map.columns, instance.length)) {
      fmt::print("line {}: {}, length {:.8f}, listed {:.8f}\n", instance.line,
                 ToString(path.status), path.cost, instance.length);
      ++wrong;
    }
  }
  return all;
}

/// Number of paths that a car can drive.
struct Counts {
  int asked = 0;
  int as_found = 0;  ///< the path on the grid, with rounded corners
  int astar = 0;     ///< another path, of the planner astar
  int hybrid = 0;    ///< a path of hybrid_astar with the same goal heading
};

Counts DriveSome(const std::vector<GridPath>& all, const GridMap& map,
                 const std::vector<OrientedBox>& walls, const VehicleParams& vehicle, int every) {
  const OccupancyGrid grid = ToOccupancyGrid(map, UnknownCells::kFree);
  // Smallest cell size that the planners accept.
  const double cell_size = std::max(0.05, 0.1 * vehicle.length);
  Counts counts;
  for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(every)) {
    std::vector<Vec2> points;
    for (const std::size_t cell : all[i].cells) {
      points.push_back(grid.CellCenter(cell));
    }
    points = WithoutCollinearPoints(points);
    if (points.size() < 2) {
      continue;
    }
    ++counts.asked;
    const Pose2 start = StartOfRoute(points);
    const Vec2 end = points.back() - points[points.size() - 2];
    // Two car lengths per second, from standstill.
    const double speed = 2.0 * vehicle.length;
    const PlanRequest request{.vehicle = vehicle,
                              .waypoints = {points.front(), points.back()},
                              .headings = {start.yaw, std::atan2(end.y(), end.x())},
                              .obstacles = walls,
                              .start = start,
                              .speed = {speed, 1.0, 1.0}};
    constexpr double kMinSpeed = 0.1;
    const Plan rounded = route::AlongPolyline({}, request, points, Corners::kRound, 0.0, kMinSpeed);
    counts.as_found += MakeFeasible(rounded, request).ok() ? 1 : 0;
    PlanRequest without_headings = request;
    without_headings.headings.clear();
    const AStarOptions astar{.safe_distance = 0.0,
                             .corner_room = 0.1 * vehicle.length,
                             .cell = cell_size,
                             .margin = 0.0,
                             .min_speed = kMinSpeed};
    counts.astar += MakePlan(without_headings, PlannerOptions(astar)).ok() ? 1 : 0;
    const HybridAStarOptions hybrid{.safe_distance = 0.0,
                                    .cell = cell_size,
                                    .margin = 0.0,
                                    .min_speed = kMinSpeed,
                                    .budget = 50000};
    counts.hybrid += MakePlan(request, PlannerOptions(hybrid)).ok() ? 1 : 0;
  }
  return counts;
}

int Run(const std::vector<std::string>& words) {
  const bool drives = words.size() == 5;
  if (words.size() != 2 && !drives) {
    fmt::print(stderr, "movingai MAP SCEN [MODEL CELL EVERY]\n");
    return 2;
  }
  const double size = drives ? std::stod(words[3]) : 1.0;
  const GridMap map = ReadMovingAiMap(words[0], size);
  int wrong = 0;
  const std::vector<GridPath> all = Solve(map, ReadMovingAiInstances(words[1]), wrong);
  fmt::print("{} instances, {} with another length than listed\n", all.size(), wrong);
  if (drives && wrong == 0) {
    Scenario scenario;
    scenario.vehicle.model = words[2];
    const MapObstacles obstacles(map, UnknownCells::kFree);
    const Counts counts = DriveSome(all, map, obstacles.boxes(), LoadCar(scenario).params(),
                                    std::max(1, std::stoi(words[4])));
    fmt::print(
        "{} on cells of {} m: of {} paths {} can be driven as found; astar finds {}, "
        "hybrid_astar {}\n",
        words[2], size, counts.asked, counts.as_found, counts.astar, counts.hybrid);
  }
  return wrong == 0 && !all.empty() ? 0 : 1;
}

}  // namespace
}  // namespace trackbed

int main(int argc, char** argv) {
  try {
    const std::span<char*> words(argv, static_cast<std::size_t>(argc));
    return trackbed::Run({words.begin() + 1, words.end()});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}

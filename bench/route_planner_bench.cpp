#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "bench/in_turn.h"
#include "tests/planning/maps.h"
#include "tests/planning/poses.h"
#include "tests/planning/routes.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"
#include "trackbed/planning/grid/astar.h"
#include "trackbed/planning/grid/hybrid_astar.h"

// Compares shortest curves with OMPL's and A* with a plain Dijkstra, and times hybrid A* and routes
// of many waypoints.
namespace trackbed::bench {
namespace {

constexpr double kRadius = 5.1;  // [m]
constexpr int kPairs = 10000;

std::vector<std::pair<Pose2, Pose2>> Pairs() {
  Random random(1);
  std::vector<std::pair<Pose2, Pose2>> pairs;
  for (int i = 0; i < kPairs; ++i) {
    pairs.emplace_back(RandomPose(random, 20.0), RandomPose(random, 20.0));
  }
  return pairs;
}

/// Compares two computations of the shortest curves between the same pairs of poses. Both compute
/// the curves and not only their lengths.
template <typename Space, typename Ours, typename Theirs>
void CompareCurves(benchmark::State& state, const Ours& ours, const Theirs& theirs) {
  const auto pairs = Pairs();
  const auto space = std::make_shared<Space>(kRadius);
  using State = ompl::base::ScopedState<Space>;
  std::vector<std::pair<State, State>> states;
  for (const auto& [from, to] : pairs) {
    auto& [a, b] = states.emplace_back(space, space);
    a->setXY(from.x, from.y);
    a->setYaw(WrapAngle(from.yaw));
    b->setXY(to.x, to.y);
    b->setYaw(WrapAngle(to.yaw));
  }
  CompareInTurn(
      state, 1.0,
      [&] {
        const Stopwatch stopwatch;
        for (const auto& [from, to] : pairs) {
          benchmark::DoNotOptimize(ours(from, to, kRadius));
        }
        return stopwatch.Seconds() / kPairs;
      },
      [&] {
        const Stopwatch stopwatch;
        for (const auto& [a, b] : states) {
          benchmark::DoNotOptimize(theirs(*space, a.get(), b.get()));
        }
        return stopwatch.Seconds() / kPairs;
      });
}

void DubinsOverOmpl(benchmark::State& state) {
  using Space = ompl::base::DubinsStateSpace;
  CompareCurves<Space>(state, Dubins, [](const Space& space, const auto* a, const auto* b) {
    return space.dubins(a, b);
  });
}

void ReedsSheppOverOmpl(benchmark::State& state) {
  using Space = ompl::base::ReedsSheppStateSpace;
  CompareCurves<Space>(state, ReedsShepp, [](const Space& space, const auto* a, const auto* b) {
    return space.reedsShepp(a, b);
  });
}

OccupancyGrid Clutter(int side, double share, std::uint64_t seed) {
  Random random(seed);
  OccupancyGrid grid;
  grid.columns = side;
  grid.rows = side;
  for (int i = 0; i < side * side; ++i) {
    grid.occupied.push_back(random.Uniform(0.0, 1.0) < share ? 1 : 0);
  }
  grid.occupied.front() = 0;
  grid.occupied.back() = 0;
  return grid;
}

/// A textbook implementation of Dijkstra's algorithm that stops when the goal leaves the queue.
double PlainDijkstra(const OccupancyGrid& grid, int start, int goal) {
  std::vector<double> cost(grid.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto free = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < grid.columns && y < grid.rows &&
           grid.occupied[static_cast<std::size_t>(y * grid.columns + x)] == 0;
  };
  cost[static_cast<std::size_t>(start)] = 0.0;
  open.push({0.0, start});
  while (!open.empty()) {
    const auto [so_far, cell] = open.top();
    open.pop();
    if (cell == goal) {
      return so_far;
    }
    if (so_far > cost[static_cast<std::size_t>(cell)]) {
      continue;
    }
    const int x = cell % grid.columns;
    const int y = cell / grid.columns;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!free(x + dx, y + dy) || !free(x + dx, y) || !free(x, y + dy)) {
          continue;
        }
        const int next = (y + dy) * grid.columns + x + dx;
        const double through = so_far + (dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0);
        if (through < cost[static_cast<std::size_t>(next)]) {
          cost[static_cast<std::size_t>(next)] = through;
          open.push({through, next});
        }
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

void CompareAStar(benchmark::State& state, const OccupancyGrid& grid, std::size_t start,
                  std::size_t goal) {
  GridPath path;
  CompareInTurn(
      state, 1.0,
      [&] {
        const Stopwatch stopwatch;
        path = SearchGrid(grid, start, goal);
        return stopwatch.Seconds();
      },
      [&] {
        const Stopwatch stopwatch;
        benchmark::DoNotOptimize(
            PlainDijkstra(grid, static_cast<int>(start), static_cast<int>(goal)));
        return stopwatch.Seconds();
      });
  state.counters["expansions"] = static_cast<double>(path.expansions);
  state.counters["found"] = path.ok() ? 1.0 : 0.0;
}

/// A wall around the goal with one gap on its far side.
OccupancyGrid Trap(int side) {
  OccupancyGrid grid = Clutter(side, 0.0, 1);
  for (int i = side / 10; i < side - 2; ++i) {
    grid.occupied[static_cast<std::size_t>(i * side + side / 10)] = 1;
    grid.occupied[static_cast<std::size_t>(side / 10 * side + i)] = 1;
  }
  return grid;
}

void TimeHybridAStar(benchmark::State& state, const HybridAStarProblem& problem,
                     const HybridAStarOptions& options) {
  HybridAStarResult result;
  for ([[maybe_unused]] auto round : state) {
    result = SearchHybridAStar(ReferenceCar(), problem, options);
    if (!result.ok()) {
      state.SkipWithError(result.reason.c_str());
      break;
    }
  }
  state.counters["cells"] = result.cells;
  state.counters["expansions"] = result.expansions;
  state.counters["cost_m"] = result.cost;
}

/// A site of 190 m with rows of boxes whose gaps alternate left and right: 150 000 cells.
HybridAStarProblem Rows() {
  HybridAStarProblem problem{.start = {0.0, 0.0, 0.0}, .goal = {170.0, 150.0, 0.5 * kPi}};
  for (int row = 0; row < 5; ++row) {
    const double x = 25.0 + 30.0 * row;
    const double shift = row % 2 == 0 ? 0.0 : 30.0;
    problem.obstacles.push_back(Block(x, -10.0 + shift, x + 3.0, 60.0 + shift));
    problem.obstacles.push_back(Block(x, 72.0 + shift, x + 3.0, 173.0));
  }
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const OrientedBox box{
        {random.Uniform(15.0, 155.0), random.Uniform(10.0, 160.0), random.Uniform(-kPi, kPi)},
        4.4,
        1.8};
    problem.obstacles.push_back(box);
  }
  return problem;
}

/// Times the planner `dubins` on a route through random waypoints.
void TimeDubinsRoute(benchmark::State& state, int legs) {
  Random random(47);
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = RandomRoute(random, legs + 1, 20.0, 60.0, 2.4);
  const Vec2 leg = request.waypoints[1] - request.waypoints[0];
  request.start = {request.waypoints[0].x(), request.waypoints[0].y(),
                   std::atan2(leg.y(), leg.x())};
  request.speed = {.speed = 5.0, .acceleration = 1.0, .deceleration = 1.5};
  const PlannerEntry dubins = DubinsPlanner();
  for ([[maybe_unused]] auto round : state) {
    const Plan plan = dubins.plan(request, dubins.defaults);
    if (!plan.ok()) {
      state.SkipWithError(plan.reason.c_str());
      break;
    }
  }
  state.counters["time_per_leg"] = benchmark::Counter(
      legs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

bool RegisterRoutePlanners() {
  constexpr int kSide = 500;
  const auto all = static_cast<std::size_t>(kSide) * kSide;
  for (const auto& [name, grid] :
       {std::pair<std::string, OccupancyGrid>{"clutter_20_percent", Clutter(kSide, 0.2, 1)},
        {"clutter_35_percent", Clutter(kSide, 0.35, 1)},
        {"empty", Clutter(kSide, 0.0, 1)},
        {"trap", Trap(kSide)}}) {
    RegisterGuarded("AStarOverDijkstra/" + name, CompareAStar, grid, std::size_t{0}, all - 1)
        ->UseManualTime()
        ->Iterations(21)
        ->Unit(benchmark::kMillisecond);
  }
  for (const auto& [name, compare] : {std::pair("DubinsOverOmpl", &DubinsOverOmpl),
                                      std::pair("ReedsSheppOverOmpl", &ReedsSheppOverOmpl)}) {
    RegisterGuarded(name, compare)->UseManualTime()->Iterations(21)->Unit(benchmark::kNanosecond);
  }
  RegisterGuarded("HybridAStar/rows", TimeHybridAStar, Rows(), HybridAStarOptions{})
      ->Unit(benchmark::kMillisecond);
  for (const int legs : {25, 250}) {
    RegisterGuarded(fmt::format("DubinsRoute/{}_legs", legs), TimeDubinsRoute, legs)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}

[[maybe_unused]] const bool route_planner_registered = RegisterRoutePlanners();

}  // namespace
}  // namespace trackbed::bench

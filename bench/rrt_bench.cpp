#include <benchmark/benchmark.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bench/in_turn.h"
#include "bench/ompl_plane.h"
#include "tests/planning/maps.h"
#include "trackbed/planning/sampling/rrt.h"

// Compares Trackbed's RRT with OMPL's: the same maps, edges, goal bias and edge check.
namespace trackbed::bench {
namespace {

constexpr double kExpandDistance = 2.0;  // [m]
constexpr double kRrtGoalBias = 0.05;    // default of both
constexpr int kBudget = 20000;           // enough for every map

/// Time per iteration [s] and path length [m] of a search.
struct RrtRun {
  double seconds = 0.0;
  double iterations = 0.0;
  double length = std::numeric_limits<double>::infinity();
};

RrtRun OurRrt(const RrtStarProblem& map, int budget, std::uint64_t seed) {
  const RrtProblem problem{.start = map.start,
                           .goal = map.goal,
                           .low = map.low,
                           .high = map.high,
                           .obstacles = map.obstacles,
                           .inflation = map.inflation};
  const RrtOptions options{.iterations = budget,
                           .expand_distance = kExpandDistance,
                           .goal_bias = kRrtGoalBias,
                           .stop = {}};
  const Stopwatch stopwatch;
  const RrtResult result = PlanRrt(problem, options, seed);
  const double seconds = stopwatch.Seconds();
  const double iterations = std::max(result.iterations, 1);
  return {seconds / iterations, iterations,
          result.ok() ? result.length : std::numeric_limits<double>::infinity()};
}

/// Times OMPL's RRT from the first sample to the last, without its setup. Its random generators
/// share the program's one seed and continue from run to run. OMPL checks the termination condition
/// once per iteration.
RrtRun OmplsRrt(const RrtStarProblem& map, int budget) {
  const ob::ProblemDefinitionPtr definition = MakeProblem(map);
  ompl::geometric::RRT planner(definition->getSpaceInformation());
  planner.setRange(kExpandDistance);
  planner.setGoalBias(kRrtGoalBias);
  planner.setProblemDefinition(definition);
  planner.setup();
  int asked = 0;
  const ob::PlannerTerminationCondition end([&] { return ++asked > budget; });
  const Stopwatch stopwatch;
  planner.solve(end);
  const double seconds = stopwatch.Seconds();
  const double iterations = std::clamp(asked, 1, budget);
  return {seconds / iterations, iterations,
          definition->hasExactSolution() ? definition->getSolutionPath()->length()
                                         : std::numeric_limits<double>::infinity()};
}

/// Compares medians over the seeds, of times per iteration and of lengths. The goal for both ratios
/// is at most 1. The ratio of the lengths may exceed 1 by the scatter of a median.
void CompareRrt(benchmark::State& state, const RrtStarProblem& map, int budget) {
  std::vector<double> our_lengths;
  std::vector<double> their_lengths;
  std::vector<double> our_iterations;
  std::vector<double> their_iterations;
  std::uint64_t seed = 0;
  CompareInTurn(
      state, 1.0,
      [&] {
        const RrtRun run = OurRrt(map, budget, ++seed);
        our_lengths.push_back(run.length);
        our_iterations.push_back(run.iterations);
        return run.seconds;
      },
      [&] {
        const RrtRun run = OmplsRrt(map, budget);
        their_lengths.push_back(run.length);
        their_iterations.push_back(run.iterations);
        return run.seconds;
      });
  state.counters["ours_iterations"] = Median(our_iterations);
  state.counters["bare_iterations"] = Median(their_iterations);
  if (std::isfinite(Median(our_lengths)) && std::isfinite(Median(their_lengths))) {
    state.counters["ours_length_m"] = Median(our_lengths);
    state.counters["bare_length_m"] = Median(their_lengths);
    state.counters["length_ratio"] = Median(our_lengths) / Median(their_lengths);
  }
}

/// The map with its goal walled in, so that every search uses its whole budget.
RrtStarProblem WalledIn(RrtStarProblem map) {
  const double reach = 2.0 * map.inflation.most + 0.5;
  for (const double side : {-1.0, 1.0}) {
    const Vec2 goal = map.goal;
    map.obstacles.push_back({{goal.x() + side * reach, goal.y(), 0.0}, 0.2, 2.0 * reach + 0.2});
    map.obstacles.push_back({{goal.x(), goal.y() + side * reach, 0.0}, 2.0 * reach + 0.2, 0.2});
  }
  return map;
}

bool RegisterRrt() {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  for (const Map& map : Maps()) {
    RegisterGuarded("RrtOverOmpl/" + map.name, CompareRrt, map.problem, kBudget)
        ->UseManualTime()
        ->Iterations(301)
        ->Unit(benchmark::kMicrosecond);
    RegisterGuarded("RrtOverOmpl/" + map.name + "/walled_in", CompareRrt, WalledIn(map.problem),
                    5000)
        ->UseManualTime()
        ->Iterations(41)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}

[[maybe_unused]] const bool rrt_registered = RegisterRrt();

}  // namespace
}  // namespace trackbed::bench

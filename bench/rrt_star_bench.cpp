#include <benchmark/benchmark.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/in_turn.h"
#include "bench/ompl_plane.h"
#include "tests/planning/maps.h"

// Compares Trackbed's RRT* with OMPL's: the same maps, step, goal bias, budget and edge check.
namespace trackbed::bench {
namespace {

constexpr double kStep = 10.0;             // [m]
constexpr double kRrtStarGoalBias = 0.05;  // default of both

struct RrtStarRun {
  double seconds = 0.0;
  double cost = std::numeric_limits<double>::infinity();
};

RrtStarRun OurRrtStar(const RrtStarProblem& problem, int iterations, std::uint64_t seed) {
  RrtStarOptions options;
  options.iterations = iterations;
  options.step = kStep;
  options.goal_bias = kRrtStarGoalBias;
  const Stopwatch stopwatch;
  const RrtStarResult result = PlanRrtStar(problem, options, seed);
  return {stopwatch.Seconds(), result.cost};
}

/// Times OMPL's RRT* from the first sample to the last, without its setup. Its random generators
/// share the program's one seed and continue from run to run.
RrtStarRun OmplsRrtStar(const RrtStarProblem& problem, int iterations) {
  const ob::ProblemDefinitionPtr definition = MakeProblem(problem);
  const ob::SpaceInformationPtr information = definition->getSpaceInformation();
  definition->setOptimizationObjective(
      std::make_shared<ob::PathLengthOptimizationObjective>(information));
  ompl::geometric::RRTstar planner(information);
  planner.setRange(kStep);
  planner.setGoalBias(kRrtStarGoalBias);
  planner.setProblemDefinition(definition);
  planner.setup();
  ob::IterationTerminationCondition budget(static_cast<unsigned>(iterations));
  const Stopwatch stopwatch;
  planner.solve(budget);
  RrtStarRun run{stopwatch.Seconds()};
  if (definition->hasExactSolution()) {
    run.cost = definition->getSolutionPath()->length();
  }
  return run;
}

/// Compares medians over the seeds, of times and of costs. The goal for both ratios is at most 1.
/// The ratio of the costs may exceed 1 by the scatter of a median, some thousandths.
void CompareRrtStar(benchmark::State& state, const RrtStarProblem& problem, int iterations) {
  std::vector<double> ours;
  std::vector<double> ompls;
  std::uint64_t seed = 0;
  CompareInTurn(
      state, 1.0,
      [&] {
        const RrtStarRun run = OurRrtStar(problem, iterations, ++seed);
        ours.push_back(run.cost);
        return run.seconds;
      },
      [&] {
        const RrtStarRun run = OmplsRrtStar(problem, iterations);
        ompls.push_back(run.cost);
        return run.seconds;
      });
  state.counters["ours_us_per_iteration"] =
      1e6 * static_cast<double>(state.counters["ours_s"]) / iterations;
  state.counters["bare_us_per_iteration"] =
      1e6 * static_cast<double>(state.counters["bare_s"]) / iterations;
  state.counters["ours_cost_m"] = Median(ours);
  state.counters["bare_cost_m"] = Median(ompls);
  state.counters["cost_ratio"] = Median(ours) / Median(ompls);
}

bool RegisterRrtStar() {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl::RNG::setSeed(1);
  for (const Map& map : Maps()) {
    for (const auto& [iterations, seeds] : {std::pair{2000, 41}, std::pair{10000, 11}}) {
      const std::string name = "RrtStarOverOmpl/" + map.name + "/" + std::to_string(iterations);
      RegisterGuarded(name, CompareRrtStar, map.problem, iterations)
          ->UseManualTime()
          ->Iterations(seeds)
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}

[[maybe_unused]] const bool rrt_star_registered = RegisterRrtStar();

}  // namespace
}  // namespace trackbed::bench

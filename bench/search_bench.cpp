#include <benchmark/benchmark.h>

#include <cmath>
#include <nlopt.hpp>
#include <string>
#include <vector>

#include "bench/in_turn.h"
#include "trackbed/drive/drive.h"
#include "trackbed/optimize/search.h"

// What the table of searches and the planner put on top of NLopt.
namespace trackbed::bench {
namespace {

constexpr int kPopulation = 100;
constexpr int kEvaluations = 10000;

/// A turn's radius under C.40 as the planner searches it: 13 m would be best, 16.8 m is the most.
double Miss(double radius) {
  const double miss = 8.0111 / radius - 0.6133;
  return miss * miss;
}
double Room(double radius) {
  return radius + 19.924 * std::atan(2.7 / radius) - 20.0;
}

/// Ours: objective and constraint of a turn, through the table, each point checked and kept.
double OursSeconds(SearchMethod method) {
  const SearchProblem problem{
      .lower = {5.1},
      .upper = {154.0},
      .start = {11.0},
      .objective = [](std::span<const double> r) { return Miss(r[0]); },
      .constraint_count = 1,
      .constraints = [](std::span<const double> r,
                        std::span<double> values) { values[0] = Room(r[0]); }};
  const Stopwatch stopwatch;
  const SearchResult result = Search(
      problem,
      {.method = method, .population = kPopulation, .evaluations = kEvaluations, .tolerance = 0.0},
      1);
  benchmark::DoNotOptimize(result.value);
  return stopwatch.Seconds();
}

/// Bare: the same call of NLopt on the same formulas, nothing between them: the values decide how
/// long isres sorts, so that an objective without any would compare something else.
double BareSeconds(nlopt::algorithm algorithm, bool constrained) {
  const Stopwatch stopwatch;
  nlopt::opt search(algorithm, 1U);
  search.set_lower_bounds(5.1);
  search.set_upper_bounds(154.0);
  search.set_min_objective([](unsigned, const double* x, double*, void*) { return Miss(x[0]); },
                           nullptr);
  if (constrained) {
    search.add_inequality_constraint(
        [](unsigned, const double* x, double*, void*) { return Room(x[0]); }, nullptr, 0.0);
  }
  search.set_maxeval(kEvaluations);
  search.set_population(kPopulation);
  nlopt::srand(1);
  std::vector<double> x{11.0};
  double value = 0.0;
  try {
    search.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    // As far as it gets.
  }
  benchmark::DoNotOptimize(value);
  return stopwatch.Seconds();
}

void CompareSearch(benchmark::State& state, SearchMethod method, nlopt::algorithm algorithm,
                   bool constrained) {
  constexpr double kLimit = 1.25;
  CompareInTurn(
      state, kLimit, [&] { return OursSeconds(method); },
      [&] { return BareSeconds(algorithm, constrained); });
}

/// The three-turn route through a searched plan, first drive and verification included.
void TimeRoute(benchmark::State& state, SearchMethod method, double limit) {
  Scenario scenario =
      ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml", {"plan.objective=turn_local"});
  std::get<FilletOptions>(*scenario.plan).search.method = method;
  const CarModel car = LoadCar(scenario);
  for ([[maybe_unused]] auto round : state) {
    benchmark::DoNotOptimize(PlanMission(scenario, car.params()).status);
  }
  state.counters["limit_s"] = limit;
}

bool RegisterSearches() {
  // The searches that use up their budget: the others end when they have converged.
  benchmark::RegisterBenchmark("SearchOverNlopt/isres", CompareSearch, SearchMethod::kIsres,
                               nlopt::GN_ISRES, true)
      ->UseManualTime()
      ->Iterations(15)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("SearchOverNlopt/esch", CompareSearch, SearchMethod::kEsch,
                               nlopt::GN_ESCH, false)
      ->UseManualTime()
      ->Iterations(15)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("ThreeTurns/isres", TimeRoute, SearchMethod::kIsres, 0.090)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("ThreeTurns/direct", TimeRoute, SearchMethod::kDirect, 0.0015)
      ->Unit(benchmark::kMillisecond);
  return true;
}

[[maybe_unused]] const bool registered = RegisterSearches();

}  // namespace
}  // namespace trackbed::bench

#include <benchmark/benchmark.h>

#include <cmath>
#include <nlopt.hpp>
#include <string>
#include <vector>

#include "bench/in_turn.h"
#include "trackbed/drive/drive.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/fillet/fillet.h"

// Measures the overhead of the table of searches and of the planner over bare NLopt.
namespace trackbed::bench {
namespace {

constexpr int kPopulation = 100;
constexpr int kEvaluations = 10000;

/// Objective of the planner's search for the radius of a turn under eq. (C.40). A radius of 13 m
/// has the least cost; the constraint Room limits the radius to 16.8 m.
double Miss(double radius) {
  const double miss = 8.0111 / radius - 0.6133;
  return miss * miss;
}
double Room(double radius) {
  return radius + 19.924 * std::atan(2.7 / radius) - 20.0;
}

/// Objective for methods without constraints: ranks infeasible radii after all feasible ones.
double Ranked(double radius) {
  constexpr double kInfeasibleCost = 1e300;
  const double room = Room(radius);
  return room > 0.0 ? kInfeasibleCost * (1.0 + room / (1.0 + room)) : Miss(radius);
}

/// Objective for methods that estimate the values of points without a value: infinite for
/// infeasible radii.
double Hidden(double radius) {
  return Room(radius) > 0.0 ? HUGE_VAL : Miss(radius);
}

/// Repeats a search, which may converge early, until it has used the budget of evaluations. Scales
/// the time to exactly this budget.
template <typename SearchOnce>
double SecondsOfBudget(const SearchOnce& search_once) {
  const Stopwatch stopwatch;
  int evaluations = 0;
  while (evaluations < kEvaluations) {
    evaluations += search_once();
  }
  return stopwatch.Seconds() * kEvaluations / evaluations;
}

/// Number of evaluations that NLopt requests. Isres and esch use the whole budget, even if they
/// request a point repeatedly.
int Asked(SearchMethod method, int budget, int evaluations) {
  const bool all = method == SearchMethod::kIsres || method == SearchMethod::kEsch;
  return all ? budget : evaluations;
}

/// Time of Trackbed's search with the objective and constraint of a turn [s]. The search checks and
/// keeps each point.
double OursSeconds(SearchMethod method, int budget) {
  const SearchProblem problem{
      .lower = {5.1},
      .upper = {154.0},
      .start = {11.0},
      .objective = [](std::span<const double> r) { return Miss(r[0]); },
      .constraint_count = 1,
      .constraints = [](std::span<const double> r,
                        std::span<double> values) { values[0] = Room(r[0]); }};
  return SecondsOfBudget([&] {
    const SearchResult result =
        Search(problem, {.method = method, .population = kPopulation, .evaluations = budget}, 1);
    return Asked(method, budget, result.evaluations);
  });
}

struct Counted {
  double (*objective)(double);
  int evaluations;
};

/// Time of the bare NLopt call with the same formulas [s]. The objective must return the same
/// values, because the values determine how long isres sorts.
double BareSeconds(nlopt::algorithm algorithm, int budget, double (*objective)(double),
                   bool random) {
  return SecondsOfBudget([&] {
    nlopt::opt search(algorithm, 1U);
    search.set_lower_bounds(5.1);
    search.set_upper_bounds(154.0);
    Counted counted{objective, 0};
    search.set_min_objective(
        [](unsigned, const double* x, double*, void* data) {
          Counted& own = *static_cast<Counted*>(data);
          ++own.evaluations;
          return own.objective(x[0]);
        },
        &counted);
    if (objective == Miss) {
      search.add_inequality_constraint(
          [](unsigned, const double* x, double*, void*) { return Room(x[0]); }, nullptr, 0.0);
    }
    search.set_maxeval(budget);
    search.set_population(kPopulation);
    search.set_xtol_abs(1e-9 * (154.0 - 5.1));
    if (random) {
      nlopt::srand(1);
    }
    std::vector<double> x{11.0};
    double value = 0.0;
    try {
      search.optimize(x, value);
    } catch (const nlopt::roundoff_limited&) {
      // Ignore the exception: NLopt keeps the best point so far.
    }
    benchmark::DoNotOptimize(value);
    return counted.evaluations;
  });
}

struct Compared {
  SearchMethod method;
  nlopt::algorithm algorithm;
  double (*objective)(double);  ///< Miss if the method handles constraints
  int budget;                   ///< evaluations of one NLopt call
};

void CompareSearch(benchmark::State& state, const Compared& compared) {
  constexpr double kLimit = 1.25;
  // With `direct`, Trackbed searches three times, each time with a third of its budget.
  const int looks = compared.method == SearchMethod::kDirect ? 3 : 1;
  CompareInTurn(
      state, kLimit, [&] { return OursSeconds(compared.method, looks * compared.budget); },
      [&] {
        return BareSeconds(compared.algorithm, compared.budget, compared.objective,
                           SearchFor(compared.method).random);
      });
}

/// Times the planning of the three-turn route with a search of the radii, including the first run
/// and the verification.
void TimeRoute(benchmark::State& state, SearchMethod method, double limit) {
  Scenario scenario =
      ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml", {"plan.objective=turn_local"});
  scenario.plan->global.Get<FilletOptions>().search.method = method;
  const CarModel car = LoadCar(scenario);
  for ([[maybe_unused]] auto round : state) {
    auto status = PlanScenario(scenario, car.params())->status;
    benchmark::DoNotOptimize(status);
  }
  state.counters["limit_s"] = limit;
}

bool RegisterSearches() {
  for (const Compared& compared :
       {Compared{SearchMethod::kIsres, nlopt::GN_ISRES, Miss, kEvaluations},
        Compared{SearchMethod::kEsch, nlopt::GN_ESCH, Ranked, kEvaluations},
        Compared{SearchMethod::kCrs2, nlopt::GN_CRS2_LM, Ranked, kEvaluations},
        Compared{SearchMethod::kDirect, nlopt::GN_ORIG_DIRECT_L, Hidden, 80},
        Compared{SearchMethod::kCobyla, nlopt::LN_COBYLA, Miss, 1000},
        Compared{SearchMethod::kNelderMead, nlopt::LN_NELDERMEAD, Ranked, 1000}}) {
    const std::string name = std::string("SearchOverNlopt/") + SearchFor(compared.method).name;
    RegisterGuarded(name, CompareSearch, compared)
        ->UseManualTime()
        ->Iterations(15)
        ->Unit(benchmark::kMillisecond);
  }
  RegisterGuarded("ThreeTurns/isres", TimeRoute, SearchMethod::kIsres, 0.090)
      ->Unit(benchmark::kMillisecond);
  RegisterGuarded("ThreeTurns/direct", TimeRoute, SearchMethod::kDirect, 0.0015)
      ->Unit(benchmark::kMillisecond);
  return true;
}

[[maybe_unused]] const bool search_registered = RegisterSearches();

}  // namespace
}  // namespace trackbed::bench

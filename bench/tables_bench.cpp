#include <benchmark/benchmark.h>

#include <exception>
#include <functional>
#include <span>
#include <string>

#include "bench/in_turn.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/drive.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed::bench {
namespace {

Scenario ThreeTurns() {
  return ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
}

/// Times the planning of the mission with a planner's default options.
void TimePlanner(benchmark::State& state, const PlannerEntry& planner) {
  Scenario scenario = ThreeTurns();
  scenario.plan = {planner.defaults, std::nullopt};
  const CarModel car = LoadCar(scenario);
  for ([[maybe_unused]] auto round : state) {
    const FeasiblePlan plan = PlanScenario(scenario, car.params());
    if (!plan.ok()) {
      state.SkipWithError(plan->reason.c_str());
      break;
    }
  }
}

/// Measures the real-time factor of simulating the mission.
void TimeDrive(benchmark::State& state, const Scenario& scenario, const std::string& plant) {
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.params());
  double simulated = 0.0;
  const Stopwatch stopwatch;
  for ([[maybe_unused]] auto round : state) {
    simulated += SimulateScenario(scenario, car, plan, plant).rows.back().state.time;
  }
  state.counters["real_time_factor"] = simulated / stopwatch.Seconds();
}

/// Times a search, and measures how near it comes to the minimum of 0.02 at (0.2, 0.6).
void TimeSearch(benchmark::State& state, SearchMethod method) {
  const SearchProblem problem{
      .lower = {0.0, 0.0},
      .upper = {1.0, 1.0},
      .start = {},
      .objective =
          [](std::span<const double> x) {
            return (x[0] - 0.3) * (x[0] - 0.3) + (x[1] - 0.7) * (x[1] - 0.7);
          },
      .constraint_count = 1,
      .constraints = [](std::span<const double> x,
                        std::span<double> values) { values[0] = x[0] + x[1] - 0.8; }};
  SearchResult result;
  for ([[maybe_unused]] auto round : state) {
    result = Search(problem, {.method = method}, 1);
  }
  state.counters["evaluations"] = result.evaluations;
  state.counters["error"] = result.value - 0.02;
}

void Register(const std::string& name, const std::function<void(benchmark::State&)>& function) {
  RegisterGuarded(name, function)->Unit(benchmark::kMillisecond);
}

/// Registers one benchmark for each entry of the tables. Entries that need more than their default
/// options report an error instead of a time.
bool RegisterTables() {
  for (const SearchEntry& search : Searches()) {
    Register(std::string("Search/") + search.name,
             [&search](benchmark::State& state) { TimeSearch(state, search.method); });
  }
  for (const PlannerEntry& planner : Planners()) {
    Register(std::string("Planner/") + planner.name,
             [&planner](benchmark::State& state) { TimePlanner(state, planner); });
  }
  for (const ControllerEntry& controller : Controllers()) {
    Register(std::string("Controller/") + controller.name, [&controller](benchmark::State& state) {
      Scenario scenario = ThreeTurns();
      scenario.control.steering = controller.defaults;
      scenario.drive.time_limit = 60.0;
      TimeDrive(state, scenario, "kinematic");
    });
  }
  for (const PlantEntry& plant : Plants()) {
    Register(std::string("Plant/") + plant.name,
             [&plant](benchmark::State& state) { TimeDrive(state, ThreeTurns(), plant.name); });
  }
  return true;
}

[[maybe_unused]] const bool tables_registered = RegisterTables();

}  // namespace
}  // namespace trackbed::bench

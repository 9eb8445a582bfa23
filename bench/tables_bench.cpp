#include <benchmark/benchmark.h>

#include <exception>
#include <functional>
#include <string>

#include "bench/in_turn.h"
#include "trackbed/drive/drive.h"

namespace trackbed::bench {
namespace {

Scenario ThreeTurns() {
  return ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
}

/// How long the mission takes to plan with a planner's defaults.
void TimePlanner(benchmark::State& state, const PlannerEntry& planner) {
  Scenario scenario = ThreeTurns();
  scenario.plan = planner.defaults;
  const CarModel car = LoadCar(scenario);
  for ([[maybe_unused]] auto round : state) {
    const Plan plan = PlanMission(scenario, car.params());
    if (!plan.ok()) {
      state.SkipWithError(plan.reason.c_str());
      break;
    }
  }
}

/// How much faster than the clock the mission is driven.
void TimeDrive(benchmark::State& state, const Scenario& scenario, const std::string& plant) {
  const CarModel car = LoadCar(scenario);
  const Plan plan = PlanMission(scenario, car.params());
  double simulated = 0.0;
  const Stopwatch stopwatch;
  for ([[maybe_unused]] auto round : state) {
    simulated += DrivePlant(scenario, car, plan, plant).rows.back().state.time;
  }
  state.counters["real_time_factor"] = simulated / stopwatch.Seconds();
}

void Register(const std::string& name, const std::function<void(benchmark::State&)>& function) {
  benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
    try {
      function(state);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  })->Unit(benchmark::kMillisecond);
}

/// One benchmark for everything in the tables, so that none is forgotten. Entries that need more
/// than their defaults say so instead of a time.
bool RegisterTables() {
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

[[maybe_unused]] const bool registered = RegisterTables();

}  // namespace
}  // namespace trackbed::bench

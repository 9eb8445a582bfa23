// Work whose instructions are counted: `counted_work CASE COUNT` does COUNT units. The difference
// between two counts cancels the setup.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "trackbed/drive/drive.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

constexpr double kTimestep = 0.002;

/// Steps a car through a slalom at 15 m/s with up to 3 m/s^2.
void Step(const std::string& model, const std::string& plant_name, int count) {
  const CarModel car(ComposeScene(FindModel(model, ""), {.timestep = kTimestep}), model);
  const World world;
  const auto plant = MakePlant(plant_name, {.car = car, .world = world, .start = {.speed = 15.0}});
  const double steering = std::atan(3.0 / (15.0 * 15.0) * car.params().wheelbase);
  for (int i = 0; i < count; ++i) {
    plant->Step({.steering = steering * std::sin(1.5 * i * kTimestep)});
  }
}

/// Runs the closed loop with preview, including its log.
void Loop(const std::string& plant, int count) {
  Scenario scenario = ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
  scenario.drive.time_limit = count * kTimestep;
  const CarModel car = LoadCar(scenario);
  SimulateScenario(scenario, car, PlanScenario(scenario, car.params()), plant);
}

/// Plans three turns with the genetic search.
void PlanTurns(int count) {
  const Scenario scenario = ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
  const CarModel car = LoadCar(scenario);
  for (int i = 0; i < count; ++i) {
    PlanScenario(scenario, car.params());
  }
}

struct Case {
  std::string name;
  std::function<void(int)> run;
};

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases{
      {"step_prius", [](int count) { Step("prius", "mujoco:magic_formula", count); }},
      {"step_bmw320i", [](int count) { Step("bmw320i", "mujoco:magic_formula", count); }},
      {"step_contacts", [](int count) { Step("bmw320i", "mujoco:contact", count); }},
      {"loop_mujoco", [](int count) { Loop("mujoco", count); }},
      {"loop_kinematic", [](int count) { Loop("kinematic", count); }},
      {"plan_three_turns", PlanTurns},
  };
  return cases;
}

}  // namespace
}  // namespace trackbed

int main(int argc, char** argv) {
  const auto& cases = trackbed::Cases();
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const trackbed::Case& one) {
    return argc == 3 && one.name == argv[1];
  });
  if (found == cases.end()) {
    std::cerr << "usage: counted_work CASE COUNT\n";
    return 2;
  }
  found->run(std::atoi(argv[2]));
  return 0;
}

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "bench/in_turn.h"
#include "trackbed/sim/plant.h"

namespace trackbed::bench {
namespace {

constexpr double kTimestep = 0.002;  // [s]
constexpr double kDuration = 20.0;   // [s]

/// Times a slalom at 15 m/s with lateral accelerations of up to 3 m/s^2. There is one command per
/// step and no log.
double DriveSlalom(const CarModel& car, const World& world, const std::string& plant) {
  const auto driven = MakePlant(plant, {.car = car, .world = world, .start = {.speed = 15.0}});
  const auto steps = static_cast<int>(std::lround(kDuration / kTimestep));
  const double amplitude = std::atan(3.0 / (15.0 * 15.0) * car.params().wheelbase);
  const Stopwatch stopwatch;
  for (int step = 0; step < steps; ++step) {
    driven->Step({.steering = amplitude * std::sin(1.5 * step * kTimestep)});
  }
  return stopwatch.Seconds();
}

/// Compares a step on Magic Formula tyres with one on MuJoCo's contact friction.
void TyreStep(benchmark::State& state, const std::string& model) {
  const CarModel car(ComposeScene(FindModel(model, ""), {.timestep = kTimestep}), model);
  const World world;
  const double median = CompareInTurn(
      state, 1.15, [&] { return DriveSlalom(car, world, "mujoco:magic_formula"); },
      [&] { return DriveSlalom(car, world, "mujoco:contact"); });
  CountStep(state, median * kTimestep / kDuration, kTimestep);
}

bool RegisterTyreStep() {
  for (const std::string model : {"prius", "bmw320i"}) {
    RegisterGuarded("TyreStep/" + model, TyreStep, model)
        ->Iterations(9)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}
[[maybe_unused]] const bool tyre_registered = RegisterTyreStep();

}  // namespace
}  // namespace trackbed::bench

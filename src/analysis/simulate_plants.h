#pragma once

#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

struct SimulatedPlant {
  RunLog log;
  DriveTiming timing;
  // Errors of the prediction windows; empty for a scenario without a recorded drive.
  std::vector<WindowErrors> windows;
  bool interrupted = false;  // Whether the simulation or its windows were interrupted.
};

/// Simulates the plants of a planned run, one after another or in parallel, as the hooks request.
/// If the simulation of a plant is interrupted, later plants are skipped. If plants run in
/// parallel, an exception in one plant interrupts the other plants and is rethrown.
std::vector<SimulatedPlant> SimulatePlants(const RunResult& planned, const CarModel& car,
                                           const RunHooks& hooks);

}  // namespace trackbed

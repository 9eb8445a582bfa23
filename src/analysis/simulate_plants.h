#pragma once

#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

struct SimulatedPlant {
  RunLog log;
  DriveTiming timing;
  std::vector<WindowErrors> windows;  // only with a record
  bool interrupted = false;           // during simulation or windows
};

/// Simulates the plants of a planned run, one after another or together, as the hooks request. If
/// one is interrupted, later plants are skipped. Together, an exception of one plant interrupts the
/// others and is rethrown.
std::vector<SimulatedPlant> SimulatePlants(const RunResult& planned, const CarModel& car,
                                           const RunHooks& hooks);

}  // namespace trackbed

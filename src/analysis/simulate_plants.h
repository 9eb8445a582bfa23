#pragma once

#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

struct SimulatedPlant {
  RunLog log;
  DriveTiming timing;
  std::vector<WindowErrors> windows;  // of a scenario with a record
  bool interrupted = false;           // in its simulation or in its windows
};

/// Simulates the plants of a run that is planned, in their order or together, as the hooks say. In
/// turn those after an interrupted one are left out; together, where one fails the others are
/// interrupted, and its exception is thrown on.
std::vector<SimulatedPlant> SimulatePlants(const RunResult& planned, const CarModel& car,
                                           const RunHooks& hooks);

}  // namespace trackbed

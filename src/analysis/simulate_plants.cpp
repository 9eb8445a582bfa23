#include "src/analysis/simulate_plants.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <string>
#include <utility>

#include "trackbed/analysis/record_metrics.h"
#include "trackbed/core/stopwatch.h"
#include "trackbed/scenario/record.h"

namespace trackbed {
namespace {

/// Simulates one plant and measures the computing time, without the time spent in the caller's hook
/// `logged`.
SimulatedPlant SimulatePlant(const RunResult& planned, const CarModel& car,
                             const std::string& plant, DriveHooks hooks) {
  DriveTiming timing{.plant = plant};
  double steering = 0.0;
  double waited = 0.0;
  hooks.steered = [&, callers = hooks.steered](double seconds) {
    ++timing.updates;
    steering += seconds;
    timing.update_max = std::max(timing.update_max, seconds);
    if (callers) {
      callers(seconds);
    }
  };
  if (hooks.logged) {
    hooks.logged = [&, callers = hooks.logged](const RunLog& log, const Table& configurations) {
      const Stopwatch waiting;
      callers(log, configurations);
      waited += waiting.Seconds();
    };
  }
  const Stopwatch driving;
  RunLog log = SimulateScenario(planned.scenario, car, planned.plan, plant, hooks);
  timing.wall_time = driving.Seconds() - waited;
  timing.real_time_factor = log.rows.back().state.time / timing.wall_time;
  timing.update_mean = timing.updates > 0 ? steering / timing.updates : 0.0;
  SimulatedPlant simulated{.log = std::move(log), .timing = timing};
  simulated.interrupted = simulated.log.status == DriveStatus::kInterrupted;
  if (planned.scenario.record && plant != kRecordedPlant && !simulated.interrupted) {
    simulated.windows = MeasureRecordWindows(planned.scenario, car, plant, hooks.interrupted);
    simulated.interrupted = hooks.interrupted && hooks.interrupted();
  }
  return simulated;
}

/// On destruction, calls the caller's hook for the end of a plant. The hook runs in the destructor,
/// so that it is called even if the simulation of the plant throws.
class PlantEndNotifier {
 public:
  PlantEndNotifier(const RunHooks& hooks, const std::string& plant)
      : hooks_(hooks), plant_(plant) {}
  PlantEndNotifier(const PlantEndNotifier&) = delete;
  PlantEndNotifier& operator=(const PlantEndNotifier&) = delete;
  ~PlantEndNotifier() {
    if (hooks_.ended) {
      hooks_.ended(plant_);
    }
  }

 private:
  const RunHooks& hooks_;
  const std::string& plant_;
};

std::vector<SimulatedPlant> SimulateTogether(const RunResult& planned, const CarModel& car,
                                             const RunHooks& hooks) {
  std::atomic<bool> failed{false};
  const auto simulate = [&](const std::string& plant) {
    const PlantEndNotifier end(hooks, plant);
    try {
      DriveHooks drive_hooks = hooks.drive ? hooks.drive(plant) : DriveHooks{};
      drive_hooks.interrupted = [&failed, callers = drive_hooks.interrupted] {
        return failed || (callers && callers());
      };
      return SimulatePlant(planned, car, plant, std::move(drive_hooks));
    } catch (...) {
      failed = true;
      throw;
    }
  };
  std::vector<std::future<SimulatedPlant>> running;
  for (const std::string& plant : planned.scenario.drive.plants) {
    running.push_back(std::async(std::launch::async, simulate, plant));
  }
  std::vector<SimulatedPlant> simulated;
  for (std::future<SimulatedPlant>& plant : running) {
    simulated.push_back(plant.get());
  }
  return simulated;
}

std::vector<SimulatedPlant> SimulateInTurn(const RunResult& planned, const CarModel& car,
                                           const RunHooks& hooks) {
  std::vector<SimulatedPlant> simulated;
  for (const std::string& plant : planned.scenario.drive.plants) {
    const PlantEndNotifier end(hooks, plant);
    simulated.push_back(
        SimulatePlant(planned, car, plant, hooks.drive ? hooks.drive(plant) : DriveHooks{}));
    if (simulated.back().interrupted) {
      break;
    }
  }
  return simulated;
}

}  // namespace

std::vector<SimulatedPlant> SimulatePlants(const RunResult& planned, const CarModel& car,
                                           const RunHooks& hooks) {
  return hooks.together ? SimulateTogether(planned, car, hooks)
                        : SimulateInTurn(planned, car, hooks);
}

}  // namespace trackbed

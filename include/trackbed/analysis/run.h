#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/drive/car_cache.h"
#include "trackbed/drive/drive.h"

namespace trackbed {

/// Wall-clock times of one plant, written to timing.json only.
struct DriveTiming {
  std::string plant;
  double wall_time = 0.0;         ///< [s]
  double real_time_factor = 0.0;  ///< simulated over wall time
  int updates = 0;                ///< of the steering
  double update_mean = 0.0;       ///< [s]
  double update_max = 0.0;        ///< [s]
};

/// One run of a scenario: planned once, simulated on each plant, measured and judged.
struct RunResult {
  Scenario scenario;
  Scene scene;            ///< the composed MJCF that was driven
  VehicleParams vehicle;  ///< the car that was driven, with its payload
  Plan plan;
  std::vector<RunLog> logs;
  std::vector<PlantMetrics> metrics;
  std::vector<PlantComparison> comparisons;  ///< every pair of plants
  Verdict verdict;
  bool interrupted = false;
  double planning_time = 0.0;  ///< wall clock [s]
  std::vector<DriveTiming> timing;
};

struct RunHooks {
  /// Called before each plant is simulated; returns the hooks of that simulation.
  std::function<DriveHooks(const std::string& plant)> drive{};
  /// Called when a plant's simulation has ended, also by an exception.
  std::function<void(const std::string& plant)> ended{};
  /// All plants at a time, each in a thread of its own, which calls its hooks; else one after the
  /// other in the caller's. The results are the same.
  bool together = false;
};

/// Plans, drives, measures, judges. A mission that cannot be planned is a failed verdict with the
/// reason and no logs. Errors: InputError from the scenario's model.
RunResult RunMission(const Scenario& scenario, const RunHooks& hooks = {});

/// The same with a car of the cache.
RunResult RunMission(const Scenario& scenario, CarCache& cars, const RunHooks& hooks = {});

/// The same for a scenario that has been checked, with its car as LoadCar would give it.
RunResult RunMission(const Scenario& scenario, const CarModel& car, const RunHooks& hooks = {});

/// The two parts of RunMission: what is known before anything is simulated, and the rest. Errors:
/// those of RunMission, and exceptions of the hooks.
RunResult PlanRun(const Scenario& scenario, const CarModel& car);
RunResult DriveRun(RunResult planned, const CarModel& car, const RunHooks& hooks = {});

/// What metrics.json holds.
nlohmann::ordered_json MetricsJson(const RunResult& result);

/// Which files a run folder has beside the usual ones.
struct RunFolderOptions {
  bool mcap = false;  ///< run.mcap, if anything was simulated
};

/// Writes the run folder (plan.csv, plan.json, <plant>.csv, <plant>.state.csv, model.xml,
/// timing.json, scenario.resolved.yaml, metrics.json, manifest.json), all at once (ResultWriter).
/// Files of an earlier run of the same folder that this run does not have are removed then, so that
/// the folder never mixes two runs. RunError when the folder cannot be written: the earlier run is
/// still there then.
void WriteRunFolder(const RunResult& result, const OutputFolder& folder,
                    const RunFolderOptions& options = {});

/// Writes plan.csv and other tables (when there is a path) and plan.json alone, likewise, of what
/// PlanRun gave.
void WritePlan(const RunResult& planned, const OutputFolder& folder);

/// Versions of Trackbed and its libraries, as in metrics.json.
nlohmann::ordered_json Versions();

}  // namespace trackbed

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"
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
  std::function<DriveHooks(const std::string& plant)> drive;
};

/// Plans, drives, measures, judges. A mission that cannot be planned is a failed verdict with the
/// reason and no logs. Errors: InputError from the scenario's model.
RunResult RunMission(const Scenario& scenario, const RunHooks& hooks = {});

/// The same with a car of the cache.
RunResult RunMission(const Scenario& scenario, CarCache& cars, const RunHooks& hooks = {});

/// The same for a scenario that has been checked, with its car as LoadCar would give it.
RunResult RunMission(const Scenario& scenario, const CarModel& car, const RunHooks& hooks = {});

/// What metrics.json holds.
nlohmann::ordered_json MetricsJson(const RunResult& result);

/// Which files a run folder has beside the usual ones.
struct RunFolderOptions {
  bool mcap = false;  ///< run.mcap, if anything was simulated
};

/// Writes the run folder (plan.csv, plan.json, <plant>.csv, <plant>.state.csv, model.xml,
/// timing.json, scenario.resolved.yaml, metrics.json) as a FileSet with metrics.json as its last
/// file: all of it, or the files of an earlier run stay as they were. RunError when the folder
/// cannot be written. Does not lock the folder; see FolderLock.
void WriteRunFolder(const RunResult& result, const std::filesystem::path& folder,
                    const RunFolderOptions& options = {});

/// Writes the files of a plan alone, likewise, with plan.json as the last one.
void WritePlan(const Plan& plan, const Scenario& scenario, const std::filesystem::path& folder);

/// Versions of Trackbed and its libraries, as in metrics.json.
nlohmann::ordered_json Versions();

}  // namespace trackbed

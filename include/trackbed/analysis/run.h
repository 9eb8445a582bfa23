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
  FeasiblePlan plan;
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
  /// Called when a plant's simulation has ended, including by an exception.
  std::function<void(const std::string& plant)> ended{};
  /// Simulate all plants at the same time, each in a separate thread that calls its hooks;
  /// otherwise one after the other in the caller's thread. The results are the same.
  bool together = false;
};

/// Plans, simulates, measures and judges. A mission that cannot be planned gives a failed verdict
/// with the reason and no logs. Errors: InputError from the scenario's model.
RunResult RunMission(const Scenario& scenario, const RunHooks& hooks = {});

/// As above, with a car of the cache.
RunResult RunMission(const Scenario& scenario, CarCache& cars, const RunHooks& hooks = {});

/// As above, for a validated scenario and a car loaded by LoadCar.
RunResult RunMission(const Scenario& scenario, const CarModel& car, const RunHooks& hooks = {});

/// The two parts of RunMission: planning before the simulation, and the simulation with its
/// evaluation. Errors: those of RunMission, and exceptions of the hooks.
RunResult PlanRun(const Scenario& scenario, const CarModel& car);
RunResult DriveRun(RunResult planned, const CarModel& car, const RunHooks& hooks = {});

/// The content of metrics.json.
nlohmann::ordered_json MetricsJson(const RunResult& result);

/// Optional files of a run folder.
struct RunFolderOptions {
  bool mcap = false;  ///< run.mcap, if anything was simulated
};

/// Writes the run folder (plan.csv, plan.json, <plant>.csv, <plant>.state.csv, model.xml,
/// timing.json, scenario.resolved.yaml, metrics.json, manifest.json) in one step (ResultWriter).
/// Removes files of an earlier run in the same folder that this run does not have, so that the
/// folder never mixes two runs. RunError when the folder cannot be written; the earlier run then
/// remains.
void WriteRunFolder(const RunResult& result, const OutputFolder& folder,
                    const RunFolderOptions& options = {});

/// Adds the same files as a result of `writer`, which may get others before it commits.
void AddRunFolder(const RunResult& result, ResultWriter& writer,
                  const RunFolderOptions& options = {});

/// Writes plan.json and, if there is a path, plan.csv and other tables of what PlanRun returned, in
/// one step (ResultWriter).
void WritePlan(const RunResult& planned, const OutputFolder& folder);

/// Versions of Trackbed and its libraries, as in metrics.json.
nlohmann::ordered_json Versions();

}  // namespace trackbed

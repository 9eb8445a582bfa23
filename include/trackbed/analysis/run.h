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
  double wall_time = 0.0;         ///< Wall-clock time of the simulation [s].
  double real_time_factor = 0.0;  ///< Simulated time divided by wall-clock time.
  int updates = 0;                ///< Number of steering updates.
  double update_mean = 0.0;       ///< Mean time of a steering update [s].
  double update_max = 0.0;        ///< Longest time of a steering update [s].
};

/// One run of a scenario: planned once, then simulated on each plant, measured and judged.
struct RunResult {
  Scenario scenario;
  Scene scene;            ///< Composed MJCF scene of the simulation.
  VehicleParams vehicle;  ///< Simulated car, with its payload.
  FeasiblePlan plan;
  std::vector<RunLog> logs;
  std::vector<PlantMetrics> metrics;
  std::vector<PlantComparison> comparisons;  ///< Comparisons of every pair of plants.
  Verdict verdict;
  bool interrupted = false;
  double planning_time = 0.0;  ///< Wall-clock time of planning [s].
  std::vector<DriveTiming> timing;
};

struct RunHooks {
  /// Called before each plant is simulated; returns the hooks of that simulation.
  std::function<DriveHooks(const std::string& plant)> drive{};
  /// Called when a plant's simulation has ended, even by an exception.
  std::function<void(const std::string& plant)> ended{};
  /// Whether to simulate all plants at the same time, each in a separate thread that calls its
  /// hooks. If false, plants run one after another in the caller's thread. The results do not
  /// depend on `together`.
  bool together = false;
};

/// Plans, simulates, measures and judges a scenario. If no plan is found, the verdict is failed
/// with a reason, and the result has no logs. Throws the InputErrors of loading the scenario's
/// vehicle model.
RunResult RunMission(const Scenario& scenario, const RunHooks& hooks = {});

/// As RunMission above, with a car from the cache.
RunResult RunMission(const Scenario& scenario, CarCache& cars, const RunHooks& hooks = {});

/// As RunMission above, for a validated scenario and a car loaded by LoadCar.
RunResult RunMission(const Scenario& scenario, const CarModel& car, const RunHooks& hooks = {});

/// The two parts of RunMission: planning, then simulation with evaluation. Both functions throw the
/// errors of RunMission. DriveRun also throws the exceptions of its hooks.
RunResult PlanRun(const Scenario& scenario, const CarModel& car);
RunResult DriveRun(RunResult planned, const CarModel& car, const RunHooks& hooks = {});

/// Returns the content of metrics.json.
nlohmann::ordered_json MetricsJson(const RunResult& result);

/// Optional files of a run folder.
struct RunFolderOptions {
  bool mcap = false;  ///< Whether to write run.mcap, if anything was simulated.
};

/// Writes the run folder (plan.csv, plan.json, <plant>.csv, <plant>.state.csv, model.xml,
/// timing.json, scenario.resolved.yaml, metrics.json, manifest.json) in one step (ResultWriter).
/// Also removes files of an earlier run that the new run does not replace, so that the folder never
/// mixes two runs. RunError if the folder cannot be written; the files of the earlier run then
/// remain.
void WriteRunFolder(const RunResult& result, const OutputFolder& folder,
                    const RunFolderOptions& options = {});

/// Adds the files that WriteRunFolder writes to `writer`, as one result. The caller may add more
/// results before the commit.
void AddRunFolder(const RunResult& result, ResultWriter& writer,
                  const RunFolderOptions& options = {});

/// Writes the result of PlanRun in one step (ResultWriter): plan.json, and plan.csv and further
/// tables if there is a path.
void WritePlan(const RunResult& planned, const OutputFolder& folder);

/// Returns the versions of Trackbed and its libraries, as in metrics.json.
nlohmann::ordered_json Versions();

}  // namespace trackbed

#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/drive/car_cache.h"
#include "trackbed/drive/drive.h"

namespace trackbed {

/// Wall-clock times of the simulation of one plant, written to timing.json only.
struct DriveTiming {
  std::string plant;
  double wall_time = 0.0;         ///< Wall-clock time of the simulation [s].
  double real_time_factor = 0.0;  ///< Simulated time divided by wall-clock time.
  int updates = 0;                ///< Number of updates of the steering controller.
  double update_mean = 0.0;  ///< Mean wall-clock time of an update of the steering controller [s].
  /// Longest wall-clock time of an update of the steering controller [s].
  double update_max = 0.0;
};

/// The results of one plant in a run.
struct PlantRun {
  const RunLog& log;
  const PlantMetrics& metrics;
};

/// Result of running a scenario: a plan, its simulation on each plant, the metrics and the verdict.
struct RunResult {
  Scenario scenario;
  Scene scene;            ///< Composed MJCF model of car and world in which the car is simulated.
  VehicleParams vehicle;  ///< Parameters of the simulated car, including its payload.
  FeasiblePlan plan;
  std::vector<RunLog> logs;
  std::vector<PlantMetrics> metrics;
  std::vector<PlantComparison> comparisons;  ///< Comparisons of every pair of plants.
  Verdict verdict;
  bool interrupted = false;
  double planning_time = 0.0;  ///< Wall-clock time of planning [s].
  std::vector<DriveTiming> timing;

  /// Returns the log and the metrics of a plant; nullopt if the run did not simulate this plant.
  /// The returned references are valid as long as the RunResult exists and is not changed.
  [[nodiscard]] std::optional<PlantRun> Find(const std::string& plant) const;
};

/// Reads a scenario file with all checks of `trackbed check`. Unlike ReadScenario, LoadScenario
/// also checks the names of the metrics in `expect.metrics`.
Scenario LoadScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {},
                      const std::vector<std::filesystem::path>& asset_folders = {});

struct RunHooks {
  /// Returns the hooks for the simulation of a plant; called before each plant is simulated.
  std::function<DriveHooks(const std::string& plant)> drive{};
  /// Receives the name of each plant whose simulation has ended, even if an exception ended the
  /// simulation.
  std::function<void(const std::string& plant)> ended{};
  /// Whether to simulate all plants at the same time, each in a separate thread that calls its
  /// hooks. If `together` is false, the plants are simulated one after another in the caller's
  /// thread. The results of the plants do not depend on `together`.
  bool together = false;
};

/// Plans, simulates, measures and judges a scenario. If no plan is found, the verdict is "failed"
/// with a reason, and the result contains no logs. Throws InputError if the scenario's vehicle
/// model cannot be loaded.
RunResult RunScenario(const Scenario& scenario, const RunHooks& hooks = {});

/// Same as RunScenario above, but takes the compiled car from the cache `cars`.
RunResult RunScenario(const Scenario& scenario, CarCache& cars, const RunHooks& hooks = {});

/// Same as RunScenario above, for a validated scenario and a car that LoadCar has loaded.
RunResult RunScenario(const Scenario& scenario, const CarModel& car, const RunHooks& hooks = {});

/// PlanRun and SimulateRun are the two parts of RunScenario: planning, then simulation with
/// evaluation. PlanRun and SimulateRun throw errors in the same cases as RunScenario. SimulateRun
/// also rethrows exceptions that its hooks throw.
RunResult PlanRun(const Scenario& scenario, const CarModel& car);
RunResult SimulateRun(RunResult planned, const CarModel& car, const RunHooks& hooks = {});

/// Runs a scenario file, as `trackbed run` does. Each of the `overrides` has the form key=value, as
/// on the command line. Throws InputError if LoadScenario throws InputError.
RunResult RunScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {});

/// Compares two plants of one run. Throws InputError unless the run has both plants.
PlantComparison Compare(const RunResult& run, const std::string& first, const std::string& second);

/// Compares one plant in two runs, for example with different controllers. In the result, the two
/// plants are named "<run>/<plant>". Throws InputError unless both runs contain the compared plant.
PlantComparison Compare(const RunResult& first, const RunResult& second, const std::string& plant);

/// Returns the content of metrics.json.
nlohmann::ordered_json MetricsJson(const RunResult& result);

/// Returns the content of plan.json. The scenario of the run must have a plan.
nlohmann::ordered_json PlanJson(const RunResult& result);

/// Optional files of a run folder.
struct RunFolderOptions {
  bool mcap = false;  ///< Whether to write the file run.mcap (only if a plant was simulated).
};

/// Writes the run folder (plan.csv, plan.json, <plant>.csv, <plant>.state.csv, model.xml,
/// timing.json, scenario.resolved.yaml, metrics.json, manifest.json) in one step (ResultWriter).
/// WriteRunFolder also removes files of an earlier run that the new run does not replace, so that
/// the folder never mixes two runs. Throws RunError if the run folder cannot be written; the files
/// of the earlier run then remain.
void WriteRunFolder(const RunResult& result, const OutputFolder& folder,
                    const RunFolderOptions& options = {});

/// Adds the files of WriteRunFolder to the ResultWriter `writer`, as one result. The caller may add
/// more results before calling ResultWriter::Commit.
void AddRunFolder(const RunResult& result, ResultWriter& writer,
                  const RunFolderOptions& options = {});

/// Writes the result of PlanRun in one step (ResultWriter): plan.json, and, if the plan has a path,
/// plan.csv and further tables.
void WritePlan(const RunResult& planned, const OutputFolder& folder);

/// Returns the versions of Trackbed and its libraries, as written to metrics.json.
nlohmann::ordered_json Versions();

}  // namespace trackbed

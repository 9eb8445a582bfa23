#include "trackbed/analysis/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/analysis/origin_statement.h"
#include "src/analysis/simulate_plants.h"
#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/evaluate_run.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/mcap.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/path_properties.h"
#include "trackbed/analysis/plan_table.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/stopwatch.h"
#include "trackbed/core/version.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/metric_names.h"
#include "trackbed/sim/scene.h"

// Plans and runs a scenario, then writes its run folder. PlanRun computes the plan. SimulateRun
// simulates all plants (simulate_plants.cpp), then measures, compares and judges them
// (evaluate_run.cpp). WriteRunFolder writes the results together with all inputs: resolved
// scenario, model, map, track and recordings. Because the run folder contains all inputs, the run
// can be repeated from its folder.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Returns a table with the knots of the open-loop steering schedule delta(D), which is the
/// steering angle as a function of the distance driven.
Table ScheduleTable(const SteeringSchedule& schedule) {
  Table table({"distance_m", "steering_rad"});
  for (const SteeringSchedule::Knot& knot : schedule.knots()) {
    table.AddRow({knot.distance, knot.steering});
  }
  return table;
}

/// Returns a table with the edges of the planner's search trees.
Table TreeTable(const std::vector<TreeNode>& tree) {
  Table table({"x_m", "y_m", "parent_x_m", "parent_y_m", "cost_m"});
  for (const TreeNode& node : tree) {
    const Vec2& parent = tree[node.parent].position;
    table.AddRow({node.position.x(), node.position.y(), parent.x(), parent.y(), node.cost});
  }
  return table;
}

/// Returns a table of the plans adopted during the run. For each plan, the table contains the rows
/// of plan.csv and the time of adoption.
Table ChangesTable(const RunLog& log) {
  std::vector<std::string> columns{"from_t_s"};
  const Table first = PlanTable(log.changes.front().plan);
  columns.insert(columns.end(), first.columns().begin(), first.columns().end());
  Table table(columns);
  for (const PlanChange& change : log.changes) {
    const Table own = PlanTable(change.plan);
    for (std::size_t row = 0; row < own.rows(); ++row) {
      std::vector<double> cells{change.time};
      for (std::size_t column = 0; column < own.columns().size(); ++column) {
        cells.push_back(own.at(row, column));
      }
      table.AddRow(cells);
    }
  }
  return table;
}

ordered_json ChangesJson(const RunLog& log) {
  ordered_json changes = ordered_json::array();
  for (const PlanChange& change : log.changes) {
    ordered_json entry{{"time_s", change.time},
                       {"station_m", change.station},
                       {"length_m", change.plan.reference.path.length()}};
    const nlohmann::json diagnostics = DiagnosticsJson(change.plan);
    for (const char* key : {"avoid", "blocked", "replan"}) {
      if (diagnostics.contains(key)) {
        entry[key] = diagnostics[key];
      }
    }
    changes.push_back(entry);
  }
  return changes;
}

void AddUnlessEmpty(const Table& table, const std::string& name, ResultWriter& writer) {
  if (table.rows() > 0) {
    writer.Add(name, table.ToCsv());
  }
}

const RunLog& FindLog(const RunResult& run, const std::string& plant) {
  if (const std::optional<PlantRun> found = run.Find(plant)) {
    return found->log;
  }
  std::vector<std::string> driven;
  for (const RunLog& log : run.logs) {
    driven.push_back(log.plant);
  }
  throw InputError(
      Problem{.message = fmt::format("the run {} has no plant {}; it has: {}", run.scenario.name,
                                     plant, fmt::join(driven, ", "))});
}

/// Checks a scenario as strictly as LoadScenario checks a file. Throws InputError.
void CheckFilledInCode(const Scenario& scenario) {
  CheckScenario(scenario);
  std::vector<Problem> problems;
  for (const auto& [key, message] : UnknownMetrics(scenario.expect, PossibleMetrics(scenario))) {
    problems.push_back({.key = key, .message = message});
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

}  // namespace

std::optional<PlantRun> RunResult::Find(const std::string& plant) const {
  const auto log = std::find_if(logs.begin(), logs.end(),
                                [&](const RunLog& each) { return each.plant == plant; });
  const auto own = std::find_if(metrics.begin(), metrics.end(),
                                [&](const PlantMetrics& each) { return each.plant == plant; });
  if (log == logs.end() || own == metrics.end()) {
    return std::nullopt;
  }
  return PlantRun{*log, *own};
}

Scenario LoadScenario(const std::filesystem::path& file, const std::vector<Override>& overrides,
                      const std::vector<std::filesystem::path>& asset_folders) {
  return ReadScenario(file, overrides, PossibleMetrics, asset_folders);
}

ordered_json Versions() {
  return {
      {"trackbed", Version()}, {"physics", PhysicsVersion()}, {"optimizer", OptimizerVersion()}};
}

RunResult RunScenario(const Scenario& scenario, const RunHooks& hooks) {
  CheckFilledInCode(scenario);
  return RunScenario(scenario, LoadCar(scenario), hooks);
}

RunResult RunScenario(const Scenario& scenario, CarCache& cars, const RunHooks& hooks) {
  CheckFilledInCode(scenario);
  return RunScenario(scenario, *cars.Load(scenario), hooks);
}

RunResult RunScenario(const Scenario& scenario, const CarModel& car, const RunHooks& hooks) {
  return SimulateRun(PlanRun(scenario, car), car, hooks);
}

RunResult RunScenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return RunScenario(LoadScenario(file, overrides));
}

RunResult PlanRun(const Scenario& scenario, const CarModel& car) {
  RunResult result;
  result.scenario = scenario;
  result.scene = car.scene();
  result.vehicle = car.params();
  const Stopwatch planning;
  result.plan = PlanScenario(scenario, car);
  result.planning_time = planning.Seconds();
  if (!result.plan.ok()) {
    result.verdict = {.passed = false,
                      .failures = {fmt::format("no plan ({}): {}", ToString(result.plan->status),
                                               result.plan->reason)}};
    NoteOrigin(result.scenario, result.verdict);
  }
  return result;
}

RunResult SimulateRun(RunResult planned, const CarModel& car, const RunHooks& hooks) {
  RunResult result = std::move(planned);
  if (!result.plan.ok()) {
    return result;
  }
  for (SimulatedPlant& simulated : SimulatePlants(result, car, hooks)) {
    AddLog(result, car, std::move(simulated.log), std::move(simulated.windows));
    result.timing.push_back(simulated.timing);
    result.interrupted = result.interrupted || simulated.interrupted;
  }
  JudgeRun(result, car);
  return result;
}

PlantComparison Compare(const RunResult& run, const std::string& first, const std::string& second) {
  return ComparePlants(FindLog(run, first), FindLog(run, second));
}

PlantComparison Compare(const RunResult& first, const RunResult& second, const std::string& plant) {
  PlantComparison comparison = ComparePlants(FindLog(first, plant), FindLog(second, plant));
  comparison.first = first.scenario.name + "/" + plant;
  comparison.second = second.scenario.name + "/" + plant;
  return comparison;
}

ordered_json MetricsJson(const RunResult& result) {
  ordered_json metrics{{"scenario", result.scenario.name}, {"complete", !result.interrupted}};
  const Vec2 origin = OriginOf(result.scenario);
  if (origin != Vec2::Zero()) {
    metrics["origin"] = OriginJson(origin);
  }
  metrics["plants"] = ordered_json::object();
  for (const PlantMetrics& plant : result.metrics) {
    metrics["plants"][plant.plant] = ToJson(plant);
  }
  metrics["between"] = ordered_json::array();
  for (const PlantComparison& comparison : result.comparisons) {
    metrics["between"].push_back(ToJson(comparison));
  }
  metrics["verdict"] = ToJson(result.verdict);
  metrics["versions"] = Versions();
  metrics["seed"] = result.scenario.seed;
  return metrics;
}

ordered_json PlanJson(const RunResult& result) {
  const Plan& plan = result.plan;
  ordered_json content{{"status", ToString(plan.status)}};
  if (!plan.ok()) {
    content["reason"] = plan.reason;
  }
  content["method"] = PlannerFor(result.scenario.plan->global).name;
  content["seed"] = result.scenario.seed;
  if (const Vec2 origin = OriginOf(result.scenario); origin != Vec2::Zero()) {
    content["origin"] = OriginJson(origin);
  }
  if (plan.ok()) {
    for (const PathProperty& property : PathProperties()) {
      if (const auto value = property.measure({plan, result.scenario.world, result.vehicle})) {
        content[property.name] = *value;
      }
    }
  }
  const nlohmann::json diagnostics = DiagnosticsJson(plan);
  for (const auto& [key, value] : diagnostics.items()) {
    content[key] = value;
  }
  return content;
}

namespace {

void AddPlan(const RunResult& result, ResultWriter& writer) {
  const Plan& plan = result.plan;
  const Vec2 origin = OriginOf(result.scenario);
  if (plan.ok()) {
    writer.Add(run_folder::kPlanCsv, WithOrigin(PlanTable(plan), origin).ToCsv());
    writer.Add(run_folder::kScheduleCsv, ScheduleTable(plan.schedule).ToCsv());
    for (const PlannerTable& table : PlannerFor(result.scenario.plan->global).tables) {
      AddUnlessEmpty(table.make(plan.diagnostics), table.file, writer);
    }
    AddUnlessEmpty(WithOrigin(TreeTable(plan.tree), origin), run_folder::kTreeCsv, writer);
  }
  writer.Add(run_folder::kPlanJson, JsonText(PlanJson(result)));
}

void AddLog(const RunLog& log, ResultWriter& writer) {
  writer.Add(run_folder::LogCsv(log.plant), CsvParts(log));
  writer.Add(run_folder::StateCsv(log.plant), log.configurations.ToCsv());
  if (!log.changes.empty()) {
    writer.Add(run_folder::NewPlansCsv(log.plant),
               WithOrigin(ChangesTable(log), log.origin).ToCsv());
    writer.Add(run_folder::NewPlansJson(log.plant), JsonText(ChangesJson(log)));
    AddUnlessEmpty(WithOrigin(TreeTable(log.changes.back().plan.tree), log.origin),
                   run_folder::NewPlansTreeCsv(log.plant), writer);
  }
}

ordered_json TimingJson(const RunResult& result) {
  ordered_json timing{{"planning_s", result.planning_time}};
  for (const DriveTiming& plant : result.timing) {
    timing["plants"][plant.plant] = {
        {"wall_s", plant.wall_time},
        {"real_time_factor", plant.real_time_factor},
        {"steering",
         {{"updates", plant.updates}, {"mean_s", plant.update_mean}, {"max_s", plant.update_max}}}};
  }
  return timing;
}

}  // namespace

void WritePlan(const RunResult& planned, const OutputFolder& folder) {
  ResultWriter writer(folder);
  AddPlan(planned, writer);
  writer.Commit(run_folder::kPlan, run_folder::PathFiles());
}

namespace {

/// Returns the model of the car without trailer, payload and world if the scenario names its own
/// model file; nullopt for a car shipped with Trackbed.
std::optional<Scene> OwnVehicle(const RunResult& result) {
  const Scenario& scenario = result.scenario;
  if (!HasOwnVehicle(scenario.vehicle)) {
    return std::nullopt;
  }
  const bool is_bare = !scenario.disturb.payload && !scenario.vehicle.trailer &&
                       !HasObstacles(scenario.world) && IsFlat(scenario.world.ground);
  return is_bare ? result.scene
                 : ComposeScene(FindModel(scenario.vehicle.model, scenario.folder),
                                MakeSceneOptions(scenario));
}

}  // namespace

void WriteRunFolder(const RunResult& result, const OutputFolder& folder,
                    const RunFolderOptions& options) {
  ResultWriter writer(folder);
  AddRunFolder(result, writer, options);
  writer.Commit();
}

void AddRunFolder(const RunResult& result, ResultWriter& writer, const RunFolderOptions& options) {
  writer.Add(run_folder::kScenarioYaml, ResolvedYaml(result.scenario));
  for (const InputFile& file : InputFiles(result.scenario)) {
    writer.Add(file.name, file.content);
  }
  if (const std::optional<Scene> vehicle = OwnVehicle(result)) {
    writer.Add(kVehicleXml, vehicle->xml);
  }
  writer.Add(run_folder::kModelXml, result.scene.xml);
  for (const SceneAsset& asset : result.scene.assets) {
    writer.Add(asset.name, asset.content);
  }
  if (result.scenario.plan) {
    AddPlan(result, writer);
  }
  for (const RunLog& log : result.logs) {
    AddLog(log, writer);
  }
  writer.Add(run_folder::kTimingJson, JsonText(TimingJson(result)));
  // Skip the MCAP file after Ctrl-C, which must end the program soon, because writing a long MCAP
  // file takes many seconds.
  if (options.mcap && !result.logs.empty() && !result.interrupted) {
    writer.Add(run_folder::kMcap, ToMcap(result));
  }
  writer.Add(run_folder::kMetricsJson, JsonText(MetricsJson(result)));
  writer.EndResult(run_folder::kRun, run_folder::AllNames());
}

}  // namespace trackbed

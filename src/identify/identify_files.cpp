#include "trackbed/identify/identify_files.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/table.h"
#include "trackbed/recording/banked_track.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json OrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json();
}

ordered_json ToJson(const ParameterEstimate& estimate) {
  const IdentifiedParameter& parameter = estimate.parameter;
  ordered_json json{{"name", parameter.name}, {"from", parameter.from}, {"to", parameter.to}};
  if (parameter.prior) {
    json["prior"] = {{"mean", parameter.prior->mean}, {"deviation", parameter.prior->deviation}};
  }
  json["start"] = estimate.start;
  json["status"] = ToString(estimate.status);
  const bool known = estimate.status != ParameterStatus::kNotIdentified;
  json["value"] = known ? ordered_json(estimate.value) : ordered_json();
  json["standard_error"] = OrNull(estimate.standard_error);
  if (!estimate.remark.empty()) {
    json["remark"] = estimate.remark;
  }
  return json;
}

ordered_json PlantJson(const PlantMetrics& plant) {
  ordered_json json;
  if (plant.recorded) {
    json["yaw_rate_relative_rms"] = OrNull(plant.recorded->yaw_rate_relative_rms);
    json["lateral_acceleration_relative_rms"] =
        OrNull(plant.recorded->lateral_acceleration_relative_rms);
    json["position_max_m"] = OrNull(plant.recorded->position_max);
  }
  json["windows"] = ordered_json::array();
  for (const WindowErrors& window : plant.windows) {
    json["windows"].push_back({{"horizon_s", window.horizon},
                               {"count", window.count},
                               {"position_median_m", OrNull(window.position_median)},
                               {"position_p90_m", OrNull(window.position_p90)},
                               {"heading_median_rad", OrNull(window.heading_median)},
                               {"heading_p90_rad", OrNull(window.heading_p90)},
                               {"yaw_rate_relative_rms", OrNull(window.yaw_rate_relative_rms)}});
  }
  return json;
}

ordered_json ToJson(const IdentifiedRecord& record) {
  ordered_json json{{"name", record.name}, {"held_out", record.held_out}};
  json["plants"] = ordered_json::object();
  for (const auto& [key, run] : {std::pair("start", &record.start), {"fitted", &record.fitted}}) {
    for (const PlantMetrics& plant : run->metrics) {
      if (plant.plant != kRecordedPlant) {
        json["plants"][plant.plant][key] = PlantJson(plant);
      }
    }
  }
  return json;
}

/// Returns a table of yaw rate and lateral acceleration over time: recorded values, and values
/// simulated by the plant before and after the fit.
Table Residuals(const IdentifiedRecord& record, const std::string& plant) {
  Table table({"t_s", "yaw_rate_recorded_radps", "yaw_rate_start_radps", "yaw_rate_fitted_radps",
               "lateral_acceleration_recorded_mps2", "lateral_acceleration_start_mps2",
               "lateral_acceleration_fitted_mps2", "valid"});
  const auto log_of = [&](const RunResult& run) -> const RunLog* {
    for (const RunLog& log : run.logs) {
      if (log.plant == plant) {
        return &log;
      }
    }
    return nullptr;
  };
  const RunLog* start = log_of(record.start);
  const RunLog* fitted = log_of(record.fitted);
  if (start == nullptr || fitted == nullptr) {
    return table;
  }
  const RecordedDrive& drive = *record.fitted.scenario.record->data;
  for (std::size_t i = 0; i < std::min(start->rows.size(), fitted->rows.size()); ++i) {
    const VehicleState& before = start->rows[i].state;
    const VehicleState& after = fitted->rows[i].state;
    const RecordedSample sample = drive.At(after.time);
    const VehicleState recorded = StateOf(sample, record.fitted.vehicle, false);
    table.AddRow({after.time, recorded.yaw_rate, before.yaw_rate, after.yaw_rate,
                  recorded.lateral_acceleration, before.lateral_acceleration,
                  after.lateral_acceleration, sample.valid ? 1.0 : 0.0});
  }
  return table;
}

}  // namespace

ordered_json ToJson(const IdentificationResult& result) {
  const Identification& study = result.study;
  ordered_json json{
      {"name", study.name},
      {"plant", study.plant},
      {"complete", !result.interrupted},
      {"windows", {{"horizon_s", study.horizon}, {"count", result.windows}}},
      {"cost", {{"start", OrNull(result.start_cost)}, {"fitted", OrNull(result.cost)}}},
      {"evaluations", result.evaluations}};
  json["notes"] = result.notes;
  json["cost"]["of_starts"] = ordered_json::array();
  for (const double cost : result.start_costs) {
    json["cost"]["of_starts"].push_back(OrNull(cost));
  }
  if (result.bank) {
    json["bank"] = {{"file", kBankCsv}, {"track_length_m", Track(result.bank->points).length()}};
  }
  json["parameters"] = ordered_json::array();
  ordered_json names = ordered_json::array();
  for (const ParameterEstimate& estimate : result.parameters) {
    json["parameters"].push_back(ToJson(estimate));
    if (estimate.standard_error) {
      names.push_back(estimate.parameter.name);
    }
  }
  json["correlation"] = {{"names", names}, {"matrix", result.correlation}};
  json["records"] = ordered_json::array();
  for (const IdentifiedRecord& record : result.records) {
    json["records"].push_back(ToJson(record));
  }
  json["versions"] = Versions();
  json["seed"] = study.seed;
  return json;
}

std::vector<std::string> IdentificationFiles(const Identification& study) {
  NameParts parts;
  for (const std::vector<Scenario>* list : {&study.fit_scenarios, &study.held_out_scenarios}) {
    for (const Scenario& scenario : *list) {
      parts["record"].push_back(scenario.name);
    }
  }
  std::vector<SceneAsset> assets;
  if (!study.fit_scenarios.empty()) {
    const CarModel car = LoadCar(study.fit_scenarios.front());
    parts["vehicle"].push_back(car.params().name);
    assets = car.scene().assets;
  }
  std::vector<std::string> names = FileNamesOfVerb("identify", parts);
  for (const SceneAsset& asset : assets) {
    names.push_back(asset.name);
  }
  return names;
}

fs::path RecordFolder(const fs::path& folder, const std::string& record) {
  return FolderBelow(folder, fs::path(run_folder::kRecords) / FileNameOf(record));
}

void WriteIdentification(const IdentificationResult& result, const OutputFolder& folder) {
  ordered_json json = ToJson(result);
  // Write the runs before identify.json. If the process is killed before identify.json is written,
  // the old identify.json does not match the new runs. By this mismatch, readers of the result
  // detect that it is incomplete.
  for (std::size_t i = 0; i < result.records.size(); ++i) {
    const IdentifiedRecord& record = result.records[i];
    const fs::path run = RecordFolder(folder.path(), record.name);
    WriteRunFolder(record.fitted, run);
    json["records"][i]["result"] = run_folder::ResultHash(run);
  }
  ResultWriter writer(folder);
  const std::string vehicle = result.records.empty()
                                  ? CarModel(result.model, result.study.file.string()).params().name
                                  : result.records.front().fitted.vehicle.name;
  writer.Add(FileNameOf(vehicle) + ".xml", result.model.xml);
  for (const SceneAsset& asset : result.model.assets) {
    writer.Add(asset.name, asset.content);
  }
  for (const IdentifiedRecord& record : result.records) {
    writer.Add(run_folder::ResidualsCsv(record.name),
               Residuals(record, result.study.plant).ToCsv());
  }
  if (result.bank) {
    writer.Add(kBankCsv, BankedTrackCsv(*result.bank));
  }
  writer.Add(run_folder::kTimingJson, JsonText(ordered_json{{"wall_s", result.wall_time}}));
  writer.Add(run_folder::kIdentifyJson, JsonText(json));
  writer.Commit(run_folder::kIdentification, {run_folder::kReport});
}

}  // namespace trackbed

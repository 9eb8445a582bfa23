#include "src/report/identification_data.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/report/numbers.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Maximum number of rows of all recorded drives together on the report page.
constexpr std::size_t kRowsOfRecords = 6000;

ordered_json Residuals(const fs::path& file, std::size_t max_points) {
  const Table table = ReadCsv(run_folder::RequireFile(file));
  const std::vector<std::size_t> rows = RowsToShow(table, max_points);
  ordered_json columns;
  for (const std::string& column : table.columns()) {
    columns[column] = RoundedColumn(table, column, rows);
  }
  return columns;
}

ordered_json OrNull(const JsonValue& value) {
  const std::optional<double> number = value.NumberOrNull();
  return number ? ordered_json(*number) : ordered_json();
}

ordered_json NumbersOrNull(const JsonValue& list) {
  ordered_json numbers = ordered_json::array();
  for (const JsonValue& element : list.Elements()) {
    numbers.push_back(OrNull(element));
  }
  return numbers;
}

ordered_json ParametersJson(const JsonValue& list) {
  ordered_json parameters = ordered_json::array();
  for (const JsonValue& parameter : list.Elements()) {
    ordered_json json{{"name", parameter.At("name").Text()},
                      {"from", parameter.At("from").Number()},
                      {"to", parameter.At("to").Number()},
                      {"start", parameter.At("start").Number()},
                      {"status", parameter.At("status").Text()},
                      {"value", OrNull(parameter.At("value"))},
                      {"standard_error", OrNull(parameter.At("standard_error"))}};
    if (const std::optional<JsonValue> remark = parameter.Find("remark")) {
      json["remark"] = remark->Text();
    }
    parameters.push_back(std::move(json));
  }
  return parameters;
}

/// Converts the correlation matrix of the estimates to JSON, with a row and a column for each name.
ordered_json CorrelationJson(const JsonValue& correlation) {
  const std::vector<std::string> names = correlation.At("names").Texts();
  ordered_json matrix = ordered_json::array();
  for (const JsonValue& row : correlation.At("matrix").Elements(names.size())) {
    static_cast<void>(row.Elements(names.size()));
    matrix.push_back(NumbersOrNull(row));
  }
  return {{"names", names}, {"matrix", matrix}};
}

/// Converts the prediction errors of one plant on one recorded drive to JSON.
ordered_json PlantJson(const JsonValue& plant) {
  ordered_json json{{"windows", ordered_json::array()}};
  if (const std::optional<JsonValue> yaw_rate = plant.Find("yaw_rate_relative_rms")) {
    json["yaw_rate_relative_rms"] = OrNull(*yaw_rate);
  }
  for (const JsonValue& window : plant.At("windows").Elements()) {
    json["windows"].push_back({{"horizon_s", window.At("horizon_s").Number()},
                               {"position_median_m", OrNull(window.At("position_median_m"))},
                               {"position_p90_m", OrNull(window.At("position_p90_m"))}});
  }
  return json;
}

ordered_json RecordJson(const JsonValue& record, const fs::path& folder, std::size_t most_rows) {
  const std::string name = record.At("name").Text();
  if (!IsFileName(name)) {
    record.At("name").Refuse("the name of a record: letters, digits, '.', '_' and '-'");
  }
  if (const std::optional<JsonValue> result = record.Find("result")) {
    run_folder::RequireResult(folder / run_folder::kRecords / name, result->Text(),
                              folder / run_folder::kIdentifyJson);
  }
  ordered_json json{{"name", name},
                    {"held_out", record.At("held_out").Flag()},
                    {"plants", ordered_json::object()}};
  for (const auto& [plant, runs] : record.At("plants").Members()) {
    json["plants"][plant] = {{"start", PlantJson(runs.At("start"))},
                             {"fitted", PlantJson(runs.At("fitted"))}};
  }
  json["residuals"] = Residuals(folder / run_folder::ResidualsCsv(name), most_rows);
  return json;
}

}  // namespace

bool IsIdentificationFolder(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / run_folder::kIdentifyJson, ignored);
}

ordered_json IdentificationData(const fs::path& folder) {
  const JsonValue json = ReadJson(folder / run_folder::kIdentifyJson);
  const JsonValue windows = json.At("windows");
  const JsonValue cost = json.At("cost");
  ordered_json data{
      {"name", json.At("name").Text()},
      {"plant", json.At("plant").Text()},
      {"complete", json.At("complete").Flag()},
      {"windows",
       {{"horizon_s", windows.At("horizon_s").Number()}, {"count", windows.At("count").Count()}}},
      {"cost",
       {{"start", OrNull(cost.At("start"))},
        {"fitted", OrNull(cost.At("fitted"))},
        {"of_starts", NumbersOrNull(cost.At("of_starts"))}}},
      {"evaluations", json.At("evaluations").Count()},
      {"parameters", ParametersJson(json.At("parameters"))},
      {"correlation", CorrelationJson(json.At("correlation"))},
      {"records", ordered_json::array()}};
  const std::vector<JsonValue> records = json.At("records").Elements();
  for (const JsonValue& record : records) {
    data["records"].push_back(RecordJson(record, folder, kRowsOfRecords / records.size()));
  }
  for (const auto& [name, version] : json.At("versions").Members()) {
    data["versions"][name] = version.Text();
  }
  return data;
}

}  // namespace trackbed

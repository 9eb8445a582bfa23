#include "src/report/study_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/report/numbers.h"
#include "src/report/search_data.h"
#include "src/report/study_difference.h"
#include "src/report/study_statistics.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/report/names.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// maximum number of rows of a study that the page shows individually
constexpr std::size_t kMaxShownRows = 4000;

/// Converts a table cell to JSON: a number, null for an empty cell, or text.
ordered_json CellJson(const std::string& cell) {
  if (cell.empty()) {
    return nullptr;
  }
  const std::optional<double> number = CellNumber(cell);
  return number ? ordered_json(Rounded(*number)) : ordered_json(cell);
}

/// Returns the description of a study, read from the sweep.json next to the table; empty if that
/// file is missing.
ordered_json StudyDescription(const fs::path& table) {
  const fs::path file = table.parent_path() / run_folder::kSweepJson;
  std::error_code ignored;
  if (table.filename() != run_folder::kSweepCsv || !fs::is_regular_file(file, ignored)) {
    return ordered_json::object();
  }
  const JsonValue json = ReadJson(file);
  const bool complete = json.At("complete").Flag();
  // The index of a row in the table equals its row number in the study only if the table has all
  // rows of the study.
  const bool has_all = complete && !json.Find("shard");
  const auto text_of = [](const std::optional<JsonValue>& text) {
    return text ? text->Text() : std::string();
  };
  const std::optional<JsonValue> bisect = json.Find("bisect");
  ordered_json versions = ordered_json::object();
  for (const auto& [name, version] : json.At("versions").Members()) {
    versions[name] = version.Text();
  }
  return {{"name", json.At("study").Text()},
          {"folder", has_all ? table.parent_path().string() : ""},
          {"scenario", json.At("scenario").Text()},
          {"complete", complete},
          {"bisected", bisect ? bisect->At("key").Text() : std::string()},
          {"stopped", text_of(json.Find("stopped"))},
          {"rows_expected", json.At("rows_expected").Count()},
          {"versions", versions},
          {"text", json.json().dump(2)}};
}

/// Returns the description of the columns of a study's table. A bisected key is treated as the
/// first output, because its value is the result of the study.
ordered_json ColumnsJson(const TextTable& table, const std::string& file,
                         const std::string& bisected = "") {
  const std::vector<std::string>& names = table.columns();
  const auto status = std::find(names.begin(), names.end(), "status");
  if (status == names.end()) {
    throw InputError(Problem{file, 1, 0, "",
                             "no column 'status' after the parameters; not the table of a study"});
  }
  ordered_json columns = ordered_json::array();
  for (auto name = names.begin(); name != names.end(); ++name) {
    const bool is_bisected = name < status && *name == bisected;
    const bool is_output = name > status || is_bisected;
    const bool is_parameter = name < status && *name != "seed";
    const ShownName shown = is_parameter ? NameOfKey(*name)
                            : is_output  ? NameOfOutput(*name)
                                         : ShownName{*name, ""};
    columns.push_back({{"name", *name},
                       {"label", shown.label},
                       {"unit", shown.unit},
                       {"kind", name == status ? "status"
                                : is_output    ? "output"
                                : is_parameter ? "parameter"
                                               : "seed"}});
  }
  return columns;
}

}  // namespace

std::optional<fs::path> StudyTable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored) && path.extension() == ".csv") {
    return path;
  }
  const fs::path table = path / run_folder::kSweepCsv;
  return fs::is_regular_file(table, ignored) ? std::optional(table) : std::nullopt;
}

TextTable ReadStudyTable(const fs::path& file) {
  // Whether the file is the original table of the study, and not a copy under another name.
  const bool is_own = file.filename() == run_folder::kSweepCsv;
  return ReadTextCsv(is_own ? run_folder::RequireFile(file) : file);
}

ordered_json StudyData(const fs::path& file, const std::optional<fs::path>& before) {
  const TextTable table = ReadStudyTable(file);
  ordered_json study = StudyDescription(file);
  if (!study.contains("name")) {
    study["name"] = file.stem().string();
  }
  study["columns"] = ColumnsJson(table, file.string(), study.value("bisected", ""));
  study["row_count"] = table.rows().size();
  const auto status =
      std::find(table.columns().begin(), table.columns().end(), "status") - table.columns().begin();
  study["passed_count"] = std::count_if(table.rows().begin(), table.rows().end(),
                                        [&](const std::vector<std::string>& row) {
                                          return HasPassed(row[static_cast<std::size_t>(status)]);
                                        });
  const ShownRows shown = StudyRowsToShow(table, kMaxShownRows);
  study["rows"] = ordered_json::array();
  study["row_numbers"] = ordered_json::array();
  study["even_count"] = shown.even.size();
  for (const std::vector<std::size_t>& rows : {shown.even, shown.extremes}) {
    for (const std::size_t i : rows) {
      ordered_json cells = ordered_json::array();
      for (const std::string& cell : table.rows()[i]) {
        cells.push_back(CellJson(cell));
      }
      study["row_numbers"].push_back(i);
      study["rows"].push_back(std::move(cells));
    }
  }
  if (ordered_json search = SearchData(file, table); !search.is_null()) {
    study["search"] = std::move(search);
    // a search has no statistics, because its runs are concentrated on the worst region and are not
    // a random sample
    study["statistics"] = nullptr;
  } else {
    study["statistics"] = StudyStatistics(table);
  }
  if (before) {
    const TextTable other = ReadStudyTable(*before);
    ColumnsJson(other, before->string());  // throws InputError if the table is not the table of a
                                           // study
    study["difference"] = StudyDifference(other, before->string(), table, file.string());
    study["difference"]["before"] =
        before->parent_path().filename() != "" ? before->parent_path().string() : before->string();
  }
  return study;
}

}  // namespace trackbed

#include "src/report/study_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "src/report/names.h"
#include "src/report/numbers.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// A number as one, an empty cell as null, all else as text.
ordered_json CellJson(const std::string& cell) {
  if (cell.empty()) {
    return nullptr;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool is_number = error == std::errc{} && end == cell.data() + cell.size();
  return is_number && std::isfinite(value) ? ordered_json(Rounded(value)) : ordered_json(cell);
}

/// What stands in sweep.json beside the table; nothing when there is none.
ordered_json StudyDescription(const fs::path& table) {
  const fs::path file = table.parent_path() / run_folder::kSweepJson;
  std::error_code ignored;
  if (table.filename() != run_folder::kSweepCsv || !fs::is_regular_file(file, ignored)) {
    return ordered_json::object();
  }
  return ReadJson(file, [](const ordered_json& json) -> ordered_json {
    return {{"name", json.at("study").get<std::string>()},
            {"scenario", json.at("scenario").get<std::string>()},
            {"complete", json.at("complete").get<bool>()},
            {"rows_expected", json.at("rows_expected").get<std::size_t>()},
            {"versions", json.at("versions").get<std::map<std::string, std::string>>()},
            {"text", json.dump(2)}};
  });
}

ordered_json ColumnsJson(const TextTable& table, const std::string& file) {
  const std::vector<std::string>& names = table.columns();
  const auto status = std::find(names.begin(), names.end(), "status");
  if (status == names.end()) {
    throw InputError(Problem{file, 1, 0, "",
                             "no column 'status' after the parameters; not the table of a study"});
  }
  ordered_json columns = ordered_json::array();
  for (auto name = names.begin(); name != names.end(); ++name) {
    const bool is_output = name > status;
    const bool is_parameter = name < status && *name != "seed";
    const ShownName shown = is_output      ? NameOfOutput(*name)
                            : is_parameter ? NameOfKey(*name)
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

ordered_json StudyData(const fs::path& file) {
  const bool is_own = file.filename() == run_folder::kSweepCsv;  // not a copy under another name
  const TextTable table = ReadTextCsv(is_own ? run_folder::RequireFile(file) : file);
  ordered_json study = StudyDescription(file);
  if (!study.contains("name")) {
    study["name"] = file.stem().string();
  }
  study["columns"] = ColumnsJson(table, file.string());
  study["rows"] = ordered_json::array();
  for (const std::vector<std::string>& row : table.rows()) {
    ordered_json cells = ordered_json::array();
    for (const std::string& cell : row) {
      cells.push_back(CellJson(cell));
    }
    study["rows"].push_back(cells);
  }
  return study;
}

}  // namespace trackbed

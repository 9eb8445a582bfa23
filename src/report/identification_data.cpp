#include "src/report/identification_data.h"

#include <algorithm>

#include "src/report/numbers.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Rows of all records together.
constexpr std::size_t kRows = 6000;

ordered_json Residuals(const fs::path& file, std::size_t most) {
  const Table table = ReadCsv(run_folder::RequireFile(file));
  const std::vector<std::size_t> rows = RowsToShow(table, most);
  ordered_json columns;
  for (const std::string& column : table.columns()) {
    columns[column] = RoundedColumn(table, column, rows);
  }
  return columns;
}

}  // namespace

bool IsIdentificationFolder(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / run_folder::kIdentifyJson, ignored);
}

ordered_json IdentificationData(const fs::path& folder) {
  ordered_json data;
  VisitJson(folder / run_folder::kIdentifyJson, [&](const ordered_json& json) {
    data = json;
    for (const char* key : {"name", "plant", "complete", "parameters", "correlation", "records"}) {
      static_cast<void>(json.at(key));
    }
    const std::size_t records = std::max<std::size_t>(json["records"].size(), 1);
    for (ordered_json& record : data["records"]) {
      const auto name = record.at("name").get<std::string>();
      record["residuals"] = Residuals(folder / run_folder::ResidualsCsv(name), kRows / records);
    }
  });
  return data;
}

}  // namespace trackbed

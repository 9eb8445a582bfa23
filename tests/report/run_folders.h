#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/file.h"
#include "trackbed/core/hash.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Replaces the manifest by an empty one, so that a test may change files.
inline void ForgetHashes(const std::filesystem::path& folder) {
  WriteFileAtomically(folder / "manifest.json", R"({"results": {}})");
}

/// Writes the manifest of a run for its current files, so that a verb may replace these files.
inline void RememberHashes(const std::filesystem::path& folder) {
  nlohmann::json manifest;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "manifest.json") {
      const std::string content = ReadFile(entry.path());
      manifest["results"]["run"][name] = {{"bytes", content.size()}, {"sha256", Sha256(content)}};
    }
  }
  WriteFileAtomically(folder / "manifest.json", manifest.dump());
}

/// Runs a scenario of a corner and writes its run folder. `keys`: YAML sections besides the
/// mission.
inline std::filesystem::path DriveCorner(const TempFolder& folder, const std::string& name,
                                         const std::string& keys) {
  const std::string yaml =
      "schema: 1\n"
      "name: corner\n"
      "mission: {speed: 3, waypoints: [[0, 0], [20, 0], [20, 20]]}\n"
      "plan: {method: fillet}\n" +
      keys;
  const std::filesystem::path out = folder.path() / name;
  WriteRunFolder(RunScenario(ParseScenario(yaml, "corner.yaml", ".")), out);
  ForgetHashes(out);  // tests change files
  return out;
}

/// Repeats the rows of a log until the log is `duration` long, with one row per `period` and the
/// original number of digits.
inline void LengthenLog(const std::filesystem::path& file, double duration, double period) {
  const Table log = ReadCsv(file);
  Table longer(log.columns());
  const auto rows = static_cast<std::size_t>(duration / period);
  for (std::size_t i = 0; i <= rows; ++i) {
    std::vector<double> row;
    for (std::size_t column = 0; column < log.columns().size(); ++column) {
      row.push_back(log.at(i % log.rows(), column));
    }
    row[0] = period * static_cast<double>(i);
    longer.AddRow(row);
  }
  WriteFileAtomically(file, longer.ToCsv());
  ForgetHashes(file.parent_path());
}

}  // namespace trackbed

#include "src/cli/sweep_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "src/cli/scenario_runs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShardFolder = "shard_";

}  // namespace

fs::path FolderOfShard(const fs::path& study, const Shard& shard) {
  return shard.count == 1
             ? study
             : study / fmt::format("{}{}_of_{}", kShardFolder, shard.index, shard.count);
}

std::vector<fs::path> RecordsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path file = at->path() / run_folder::kSweepRecords;
    if (at->path().filename().string().starts_with(kShardFolder) && fs::exists(file, error)) {
      files.push_back(file);
    }
  }
  if (files.empty()) {
    files.push_back(folder / run_folder::kSweepRecords);
    if (!fs::exists(files.back(), error)) {
      throw InputError(Problem{.file = folder.string(),
                               .message = fmt::format("has neither {} nor folders of shards",
                                                      run_folder::kSweepRecords)});
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

fs::path FolderOfRow(const fs::path& study, std::size_t row) {
  return study / "rows" / std::to_string(row);
}

void RemoveKeptRows(const fs::path& study) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator at(study / "rows", error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (at->is_directory(error) && !at->is_symlink(error) &&
        name.find_first_not_of("0123456789") == std::string::npos &&
        fs::exists(at->path() / run_folder::kManifest, error)) {
      folders.push_back(at->path());
    }
  }
  for (const fs::path& folder : folders) {
    fs::remove_all(folder, error);
  }
}

void KeepWorstRows(const SweepRecords& records, const fs::path& study,
                   const ScenarioOptions& options) {
  const nlohmann::ordered_json& header = records.header();
  if (!header.contains("keep") || !header["keep"].is_object()) {
    return;
  }
  for (const std::size_t row : WorstRows(records)) {
    const fs::path folder = FolderOfRow(study, row);
    std::error_code ignored;
    if (fs::exists(folder / run_folder::kMetricsJson, ignored)) {
      continue;
    }
    ScenarioOptions own = options;
    own.overrides = OverridesOfRow(records, row);
    const auto [locked, result] =
        DriveScenario({own.Read(header.at("scenario").get<std::string>()), folder}, options.quiet);
    if (result.interrupted) {
      return;
    }
    WriteRunFolder(result, locked);
  }
}

void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep) {
  if (sweep.refused + sweep.errors > 0) {
    std::fflush(stdout);  // behind what is said of all rows
    fmt::print(stderr,
               "{}: {} rows without a run: {} refused, {} with an internal error; see the "
               "column reason\n",
               name, sweep.refused + sweep.errors, sweep.refused, sweep.errors);
  }
}

}  // namespace trackbed::cli

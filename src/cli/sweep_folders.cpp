#include "src/cli/sweep_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShardFolder = "shard_";

/// Returns the existing run folders of those rows whose results the study keeps. KeptRows throws
/// RunError if a folder is a link.
std::vector<fs::path> KeptRows(const fs::path& study) {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path rows = FolderBelow(study, run_folder::kRows);
  for (fs::directory_iterator at(rows, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos) {
      folders.push_back(FolderBelow(study, fs::path(run_folder::kRows) / name));
    }
  }
  return folders;
}

}  // namespace

fs::path FolderOfShard(const fs::path& study, const Shard& shard) {
  return shard.count == 1 ? study
                          : FolderBelow(study, fmt::format("{}{}_of_{}", kShardFolder, shard.index,
                                                           shard.count));
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
  return FolderBelow(study, fs::path(run_folder::kRows) / std::to_string(row));
}

void CheckKeptRows(const fs::path& study) {
  for (const fs::path& folder : KeptRows(study)) {
    RequireNoForeignFiles(folder, run_folder::AllNames());
  }
}

void RemoveKeptRows(const fs::path& study) {
  for (const fs::path& folder : KeptRows(study)) {
    RemoveResults(folder);
  }
}

void KeepWorstRows(const SweepRecords& records, const fs::path& study,
                   const ScenarioOptions& options) {
  const JsonValue header = records.Header();
  const std::optional<JsonValue> keep = header.Find("keep");
  if (!keep) {
    return;
  }
  if (!keep->IsSection()) {
    // If the study keeps "all" or "failed" rows, there is nothing to do, because the run folder of
    // a row was written directly after the run.
    static_cast<void>(keep->Text());
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
    const auto [locked, result, finishing] =
        DriveScenario({own.Read(header.At("scenario").Text()), folder}, options.quiet);
    if (result.interrupted) {
      return;
    }
    WriteRunFolder(result, locked);
  }
}

void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep) {
  if (sweep.refused + sweep.errors > 0) {
    std::fflush(stdout);  // flush stdout, so that its text precedes the text on stderr
    PrintTo(stderr,
            "{}: {} rows without a run: {} refused, {} with an internal error; see the "
            "column reason\n",
            name, sweep.refused + sweep.errors, sweep.refused, sweep.errors);
  }
}

}  // namespace trackbed::cli

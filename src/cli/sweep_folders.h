#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "trackbed/analysis/sweep.h"

/// Output folder of a study: records of its shards and run folders of rows.
namespace trackbed::cli {

/// Folder of a shard, below that of the study. RunError for a link, as FolderBelow.
std::filesystem::path FolderOfShard(const std::filesystem::path& study, const Shard& shard);

/// Record files of a folder or of the shards in it, ordered by name. Throws InputError if there are
/// none.
std::vector<std::filesystem::path> RecordsIn(const std::filesystem::path& folder);

/// Run folder of a row. RunError for a link, as FolderBelow.
std::filesystem::path FolderOfRow(const std::filesystem::path& study, std::size_t row);

/// RunError when the folder of rows or one of them is a link, or has a file with the name of a
/// run's file that Trackbed has not written.
void CheckKeptRows(const std::filesystem::path& study);

/// Removes the runs in the folders of rows. Files of others stay (RemoveResults).
void RemoveKeptRows(const std::filesystem::path& study);

/// Repeats the worst rows that the study keeps, unless their run folders exist.
void KeepWorstRows(const SweepRecords& records, const std::filesystem::path& study,
                   const ScenarioOptions& options);

/// Prints the number of rows without a run to stderr, if there are any.
void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep);

}  // namespace trackbed::cli

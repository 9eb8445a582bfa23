#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "trackbed/analysis/sweep.h"

/// Output folder of a study: records of its shards and run folders of rows.
namespace trackbed::cli {

/// Folder of a shard, below the folder of the study. FolderOfShard throws RunError for a link, as
/// FolderBelow does.
std::filesystem::path FolderOfShard(const std::filesystem::path& study, const Shard& shard);

/// Record files of a folder, or of the shards in it, ordered by name. RecordsIn throws InputError
/// if there are no record files.
std::vector<std::filesystem::path> RecordsIn(const std::filesystem::path& folder);

/// Run folder of a row. FolderOfRow throws RunError for a link, as FolderBelow does.
std::filesystem::path FolderOfRow(const std::filesystem::path& study, std::size_t row);

/// Throws RunError if the folder of rows or one of its folders is a link. CheckKeptRows also throws
/// if a file that Trackbed has not written has the name of a run's file.
void CheckKeptRows(const std::filesystem::path& study);

/// Removes the runs in the folders of kept rows. Files that Trackbed has not written stay
/// (RemoveResults).
void RemoveKeptRows(const std::filesystem::path& study);

/// Repeats the worst rows of the study that it asks to keep, unless their run folders exist.
void KeepWorstRows(const SweepRecords& records, const std::filesystem::path& study,
                   const ScenarioOptions& options);

/// Prints the number of rows without a run to stderr, unless it is zero.
void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep);

}  // namespace trackbed::cli

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "trackbed/analysis/sweep.h"

/// Functions for the output folder of a study, which contains the records of the shards and the run
/// folders of rows.
namespace trackbed::cli {

/// Returns the folder of a shard inside the folder of the study. FolderOfShard throws RunError if
/// the shard's folder is a link.
std::filesystem::path FolderOfShard(const std::filesystem::path& study, const Shard& shard);

/// Returns the record files in a study's folder or in the folders of its shards, ordered by name.
/// RecordsIn throws InputError if no record files exist.
std::vector<std::filesystem::path> RecordsIn(const std::filesystem::path& folder);

/// Returns the run folder of a study's row. FolderOfRow throws RunError if the run folder is a
/// link.
std::filesystem::path FolderOfRow(const std::filesystem::path& study, std::size_t row);

/// Throws RunError if the study's folder of kept rows is a link, or if a run folder in that folder
/// is a link. CheckKeptRows also throws if a run folder contains a file that Trackbed would
/// overwrite but has not written.
void CheckKeptRows(const std::filesystem::path& study);

/// Removes the run results from the run folders of a study's rows. RemoveKeptRows does not remove
/// files that Trackbed has not written (see RemoveResults).
void RemoveKeptRows(const std::filesystem::path& study);

/// If the study asks to keep the worst rows, repeats the runs of these rows and writes their run
/// folders. KeepWorstRows skips rows whose run folders already exist.
void KeepWorstRows(const SweepRecords& records, const std::filesystem::path& study,
                   const ScenarioOptions& options);

/// Prints to stderr how many rows could not be run; prints nothing if all rows were run.
void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep);

}  // namespace trackbed::cli

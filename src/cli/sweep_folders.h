#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "trackbed/analysis/sweep.h"

/// The output folder of a study: the records of its shards, and the run folders of rows.
namespace trackbed::cli {

/// Where a shard has its files, below the folder of the study.
std::filesystem::path FolderOfShard(const std::filesystem::path& study, const Shard& shard);

/// The records of a folder, or of the shards in it, in the order of their names. InputError where
/// there are none.
std::vector<std::filesystem::path> RecordsIn(const std::filesystem::path& folder);

/// The run folder of a row.
std::filesystem::path FolderOfRow(const std::filesystem::path& study, std::size_t row);

/// Removes the run folders of rows.
void RemoveKeptRows(const std::filesystem::path& study);

/// Runs once more the rows with the worst values that the study keeps, those that are not there
/// yet.
void KeepWorstRows(const SweepRecords& records, const std::filesystem::path& study,
                   const ScenarioOptions& options);

/// Says how many rows of a study had no run, on the standard error stream, if any.
void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep);

}  // namespace trackbed::cli

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Comparisons of the plants of one run, or of two finished runs, with a verdict.
namespace trackbed {

/// One compared pair of plants or runs.
struct ComparedPair {
  PlantComparison comparison;
  DifferenceBounds bounds;     ///< Tolerances of the differences.
  Table differences{{"s_m"}};  ///< Table returned by DifferencesOverArcLength.
};

struct RunComparison {
  /// The folders of the compared runs; empty for a run in memory.
  std::vector<std::filesystem::path> runs;
  std::vector<ComparedPair> pairs;
  Verdict verdict;

  /// Whether the comparison has tolerances. Without tolerances, the comparison can fail but not
  /// pass.
  [[nodiscard]] bool judged() const;

  /// Returns "failed", "passed", or, if nothing failed and there were no tolerances, "compared".
  [[nodiscard]] const char* status() const;
};

/// Compares every pair of the plants of a run. Judges the differences by `tolerances`; the default
/// is the scenario's section `expect.between`. Every plant must also end with the status that the
/// scenario expects, by default "arrived". If the run has no plan, the comparison fails.
RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances);

/// Compares finished runs, using only the files in their folders.
///
/// With one folder, compares every pair of `plants` (default: all plants of the run) and judges the
/// differences by `tolerances`. The default tolerances are those of the scenario's section
/// `expect.between`.
///
/// With two folders, compares each of `plants` in the first run with the same plant in the second
/// (default: the plants that both runs have). If `plants` has two names, compares the first plant
/// of the first run with the second plant of the second run. Judges the differences only by
/// `tolerances`; a note states whether the plans of the two runs differ.
///
/// With tolerances, the comparison of two plants fails if they ended with different statuses.
/// InputError if a folder is not a complete run, if a plant is missing or listed twice, or if there
/// is nothing to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Parses tolerances in SI units: "position=0.1", "heading=…", "yaw_rate=…" and "steering=…".
/// InputError for unknown or repeated names, and for values that are not numbers of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes compare.csv, compare.json and manifest.json in one step (ResultWriter). The first column
/// of compare.csv, `pair`, is the number of the compared pair; the other columns are those of
/// DifferencesOverArcLength. Removes the report.html of an earlier comparison. Without tolerances,
/// the written verdict is neither passed nor failed. Relative paths of run folders are stored
/// relative to the output folder. If writing fails with a RunError, the files of an earlier
/// comparison remain.
void WriteComparison(const RunComparison& comparison, const OutputFolder& folder);

/// Adds the files that WriteComparison writes to `writer`, as one result. `folder` is the output
/// folder of `writer`.
void AddComparison(const RunComparison& comparison, const std::filesystem::path& folder,
                   ResultWriter& writer);

}  // namespace trackbed

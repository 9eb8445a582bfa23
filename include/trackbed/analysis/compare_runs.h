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
  Table differences{{"s_m"}};  ///< Result of DifferencesOverArcLength.
};

struct RunComparison {
  /// The folders of the compared runs; empty for a run in memory.
  std::vector<std::filesystem::path> runs;
  std::vector<ComparedPair> pairs;
  Verdict verdict;

  /// Whether there were tolerances. Without tolerances, a verdict that has not failed is
  /// inconclusive.
  [[nodiscard]] bool judged() const;

  /// The status "failed", "passed", or "compared" if there were no tolerances.
  [[nodiscard]] const char* status() const;
};

/// Compares every pair of the plants of a run. The differences are judged by `tolerances`, by
/// default by the scenario's expect.between. Every plant must also end as the scenario expects, by
/// default by arriving. A run without a plan fails.
RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances);

/// Compares finished runs, using only the files in their folders.
///
/// With one folder, compares every pair of `plants` (default: all plants of the run). The
/// differences are judged by `tolerances`, by default by the scenario's expect.between.
///
/// With two folders, compares each of `plants` in the first run with the same plant in the second
/// (default: the plants that both runs have). If `plants` has two names, compares the first plant
/// of the first run with the second plant of the second run. The differences are judged only by
/// `tolerances`; a note states whether the plans differ.
///
/// With tolerances, plants that ended with different statuses fail. InputError if a folder is not a
/// complete run, if a plant is missing or listed twice, or if there is nothing to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Parses tolerances in SI units: "position=0.1", "heading=…", "yaw_rate=…" and "steering=…".
/// InputError for unknown or repeated names, and for values that are not numbers of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes compare.csv, compare.json and manifest.json in one step (ResultWriter). The first column
/// of compare.csv is the number of the `pair`; the others are the differences over arc length.
/// Removes the report.html of an earlier comparison. Without tolerances, the verdict is neither
/// passed nor failed. Relative paths of run folders are stored relative to the output folder. If a
/// RunError occurs, the earlier comparison remains.
void WriteComparison(const RunComparison& comparison, const OutputFolder& folder);

/// Adds the files of WriteComparison as a result of `writer`, which writes to `folder`.
void AddComparison(const RunComparison& comparison, const std::filesystem::path& folder,
                   ResultWriter& writer);

}  // namespace trackbed

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

/// One compared pair.
struct ComparedPair {
  PlantComparison comparison;
  DifferenceBounds bounds;     ///< tolerances
  Table differences{{"s_m"}};  ///< DifferencesOverArcLength
};

struct RunComparison {
  /// The folders of the compared runs; empty for a run in memory.
  std::vector<std::filesystem::path> runs;
  std::vector<ComparedPair> pairs;
  Verdict verdict;

  /// Whether there were tolerances; without them, a verdict that has not failed is inconclusive.
  [[nodiscard]] bool judged() const;

  /// "failed"; else "passed", or "compared" when nothing was judged.
  [[nodiscard]] const char* status() const;
};

/// Every pair of the plants of a run. Judged by `tolerances`, or else by the scenario's
/// expect.between; every plant must also end as the scenario expects, by default by arriving. A run
/// without a plan fails.
RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances);

/// Compares finished runs, from their folders alone. One folder: every pair of `plants` (default:
/// all plants of the run), judged by `tolerances`, or else by the scenario's expect.between. Two
/// folders: each of `plants` (default: the plants that both runs have) in the first and in the
/// second run; if `plants` has two names, the first plant of the first run against the second plant
/// of the second. Two folders are judged by `tolerances` alone, with a note if their plans differ.
/// With tolerances, plants that ended differently fail. InputError when a folder is not a complete
/// run, a plant is missing or listed twice, or nothing is left to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Reads "position=0.1", "heading=", "yaw_rate=" and "steering=" [SI]. InputError for unknown or
/// repeated names, and for values that are not numbers of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes compare.csv (the differences over arc length, with the number of the `pair` in front),
/// compare.json and manifest.json in one step (ResultWriter), and removes the report.html of an
/// earlier comparison. Without tolerances, the verdict is neither passed nor failed. Paths of run
/// folders are stored relative to the output folder, unless given as absolute paths. On a RunError,
/// the earlier comparison remains.
void WriteComparison(const RunComparison& comparison, const OutputFolder& folder);

/// Adds the same files as a result of `writer`, which writes to `folder`.
void AddComparison(const RunComparison& comparison, const std::filesystem::path& folder,
                   ResultWriter& writer);

}  // namespace trackbed

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

/// Finished runs, from their folders alone. Of one: every pair of `plants`, or of all that it has,
/// judged by `tolerances`, or else by its scenario's expect.between. Of two: each of `plants`, or
/// of those that both have, in the first and in the second; or, if `plants` are two, the first of
/// them in the first run and the second in the second; judged by `tolerances` alone, with a note if
/// their plans differ. With tolerances, plants that ended differently fail. InputError when a
/// folder is not a complete run, a plant is missing or listed twice, or nothing is left to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Reads "position=0.1", "heading=", "yaw_rate=" and "steering=" [SI]. InputError for names that
/// are none of these or given twice, and values that are no numbers of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes compare.csv (the differences over arc length, with the number of the `pair` in front),
/// compare.json and manifest.json, all at once (ResultWriter), and removes the report.html of an
/// earlier comparison. Without tolerances, the verdict is neither passed nor failed. Run folders
/// are stored relative to its own, unless given as absolute paths. RunError: the earlier comparison
/// is still there then.
void WriteComparison(const RunComparison& comparison, const OutputFolder& folder);

}  // namespace trackbed

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/run.h"

/// Comparisons of whole runs: of the plants of one, or of two finished ones, with a verdict.
namespace trackbed {

/// One pair of drives.
struct ComparedPair {
  PlantComparison comparison;
  DifferenceBounds bounds;     ///< what it is judged by
  Table differences{{"s_m"}};  ///< DifferencesOverArcLength
};

struct RunComparison {
  /// The finished runs that it is of; none of a run that has just been made.
  std::vector<std::filesystem::path> runs;
  std::vector<ComparedPair> pairs;
  Verdict verdict;

  /// Whether there was anything to hold a difference against; without it a verdict that has not
  /// failed says little.
  [[nodiscard]] bool judged() const;

  /// "failed"; else "passed", or "compared" when nothing was judged.
  [[nodiscard]] const char* status() const;
};

/// Every pair of the plants of a run. Judged by `tolerances`, or else by what the scenario expects
/// `between` them; and every drive must end as the scenario expects, which is by arriving unless it
/// says otherwise. A run without a plan fails.
RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances);

/// Finished runs, from their folders alone. Of one: every pair of `plants`, or of all that it has,
/// judged by `tolerances`, or else by what its scenario expects `between` them. Of two: each of
/// `plants`, or of those that both have, in the first and in the second; or, if `plants` are two,
/// the first of them in the first run and the second in the second; judged by `tolerances` alone,
/// with a note when the two were not to drive one plan. Where there are bounds, drives that ended
/// differently fail. InputError when a folder is no complete run, a plant was not driven or is
/// listed twice, or nothing is left to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Reads "position=0.1", "heading=", "yaw_rate=" and "steering=" [SI]. InputError for names that
/// are none of these or given twice, and values that are no numbers of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes compare.csv (the differences over arc length, with the number of the `pair` in front),
/// then compare.json, each under its name only when complete; a report.html of an earlier
/// comparison goes first. Where nothing was judged, the verdict in it has neither passed nor
/// failed. Folders of runs stand in it as seen from its own, unless they were given from the root
/// on. RunError.
void WriteComparison(const RunComparison& comparison, const std::filesystem::path& folder);

}  // namespace trackbed

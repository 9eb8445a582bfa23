#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Compares the plants of one run, or two finished runs, and judges the differences.
namespace trackbed {

/// A compared pair of plants or runs.
struct ComparedPair {
  PlantComparison comparison;
  DifferenceBounds bounds;  ///< Tolerances by which the differences are judged.
  /// Table of the differences, as returned by DifferencesOverArcLength.
  Table differences{{"s_m"}};
};

struct RunComparison {
  /// Folders of the compared runs; empty for a run in memory.
  std::vector<std::filesystem::path> runs;
  std::vector<ComparedPair> pairs;
  Verdict verdict;

  /// Whether the comparison has tolerances for the differences. A comparison without tolerances can
  /// fail but cannot pass.
  [[nodiscard]] bool judged() const;

  /// Returns the verdict as text: "failed", "passed", or "compared" if nothing failed but the
  /// comparison has no tolerances.
  [[nodiscard]] const char* status() const;
};

/// Compares every pair of the plants of a run. The differences are judged by `tolerances`, by
/// default those of the scenario's section `expect.between`. Every plant must also end with the
/// status that the scenario expects, by default "arrived". If the run has no plan, the comparison
/// fails.
RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances);

/// Compares finished runs, using only the files in their folders.
///
/// With one folder, compares every pair of `plants` (default: all plants of the run). The
/// differences are judged by `tolerances`, by default those of the scenario's section
/// `expect.between`.
///
/// With two folders, compares each of `plants` in the first run with the same plant in the second
/// (default: the plants that both runs have). If `plants` has two names, compares the first plant
/// of the first run with the second plant of the second run. The differences between two runs are
/// judged only by `tolerances`, which have no default. A note states whether the plans of the two
/// runs differ.
///
/// If the comparison has tolerances, the comparison of two plants fails if the two plants ended
/// with different statuses. Throws InputError if a folder does not contain a complete run, if a
/// plant is missing or listed twice, or if there is nothing to compare.
RunComparison CompareFolders(const std::vector<std::filesystem::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances);

/// Parses tolerances from texts such as "position=0.1", in SI units. The names are position,
/// heading, yaw_rate and steering. Throws InputError if a name is unknown or repeated, or if a
/// value is not a number of at least 0.
DifferenceBounds ParseTolerances(const std::vector<std::string>& texts);

/// Writes the result of a comparison (compare.csv, compare.json, manifest.json) in one step, by a
/// ResultWriter. The first column of compare.csv, `pair`, is the number of the compared pair; the
/// other columns are those of DifferencesOverArcLength. WriteComparison removes the report.html of
/// an earlier comparison. For a comparison without tolerances, the written verdict is neither
/// passed nor failed. If the path of a run folder is relative, compare.json stores it relative to
/// the output folder. If writing fails with a RunError, the files of an earlier comparison remain.
void WriteComparison(const RunComparison& comparison, const OutputFolder& folder);

/// Adds the files of WriteComparison to the ResultWriter `writer`, as one result. `folder` is the
/// output folder of `writer`.
void AddComparison(const RunComparison& comparison, const std::filesystem::path& folder,
                   ResultWriter& writer);

}  // namespace trackbed

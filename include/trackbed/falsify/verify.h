#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/analysis/sweep.h"
#include "trackbed/falsify/sequential_test.h"
#include "trackbed/scenario/study_points.h"

/// Simulates sampled points of a study until a claim about the fraction of passing runs is decided.
namespace trackbed {

struct VerifyClaim {
  /// Claimed lower bound on the probability that a run passes; in (0, 1).
  double probability = 0.99;
  double confidence = 0.95;  ///< Confidence of the verdict, in (0, 1).
};

struct VerifyOptions {
  int jobs = 1;  ///< Number of runs that are simulated at the same time, at least 1.
  /// Returns true to stop the verification; called before each run, by any thread.
  std::function<bool()> interrupted{};
  /// Callback with the fraction of the sample that is finished; only one thread at a time calls the
  /// callback.
  std::function<void(double fraction)> progress{};
};

struct VerifyResult {
  ProbabilityVerdict verdict = ProbabilityVerdict::kUndecided;
  /// Number of runs until the verdict; points with an invalid scenario are not counted.
  std::size_t runs = 0;
  std::size_t passed = 0;  ///< Number of passing runs until the verdict.
  /// Number of points at which the scenario is invalid; these points are not counted as runs.
  std::size_t refused = 0;
  bool interrupted = false;
};

/// Throws InputError unless the study has a single grid point and a sample whose method is
/// `random`. The statistical test needs independent trials; with other sampling methods, the points
/// are not independent. Throws InputError if the study has `repeat` or `bisect`.
void CheckVerifiable(const StudyPoints& points);

/// Simulates the points of the sample in order until SequentialTest has a verdict or the sample is
/// used up. A run that does not pass counts as a failure, even if the planner found no plan. Points
/// with an invalid scenario are not counted, because the claim is about valid scenarios only.
///
/// Appends rows to `records` (SweepHeader) and reuses the rows that `records` already contains. The
/// points of the study are simulated in batches of 32. Runs that follow the verdict in the same
/// batch are not counted.
///
/// Guarantees: the result does not depend on the number of jobs or on interruptions. Throws
/// InputError in the same cases as CheckVerifiable, and if the scenario has no expectations. Throws
/// RunError if the environment fails. Throws InternalError if a run reveals a bug in the program.
VerifyResult Verify(const CheckedStudy& checked, const VerifyClaim& claim, SweepRecords& records,
                    const VerifyOptions& options = {});

/// Returns the result of a verification in the format of verify.json.
nlohmann::ordered_json ToJson(const VerifyResult& result, const VerifyClaim& claim);

/// Formats the verdict as a sentence: "at least 0.99 of the runs pass, with 95 % confidence".
std::string ToText(const VerifyResult& result, const VerifyClaim& claim);

}  // namespace trackbed

#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/analysis/sweep.h"
#include "trackbed/falsify/sequential_test.h"

/// Runs a sample of a study until the fraction of passing runs is known accurately enough to decide
/// a claim.
namespace trackbed {

struct VerifyClaim {
  /// Claimed lower bound on the probability that a run passes; in (0, 1).
  double probability = 0.99;
  double confidence = 0.95;  ///< Confidence of the verdict, in (0, 1).
};

struct VerifyOptions {
  int jobs = 1;  ///< Number of runs at the same time, at least 1.
  /// Returns whether to stop; called before each run, by any thread.
  std::function<bool()> interrupted{};
  /// Called with the finished fraction of the sample, by one thread at a time.
  std::function<void(double fraction)> progress{};
};

struct VerifyResult {
  ProbabilityVerdict verdict = ProbabilityVerdict::kUndecided;
  std::size_t runs = 0;    ///< Number of runs until the verdict, without refused points.
  std::size_t passed = 0;  ///< Number of runs until the verdict that passed.
  /// Number of points with an invalid scenario, which are not counted as runs.
  std::size_t refused = 0;
  bool interrupted = false;
};

/// InputError unless the study is a single grid point with a sample whose method is `random`. The
/// test needs independent trials, and points of other samples are not independent. InputError if
/// the study has `repeat` or `bisect`.
void CheckVerifiable(const StudyPoints& points);

/// Runs the rows of the sample in order until SequentialTest has a verdict or the sample is used
/// up. A run that does not pass is a failure, even if it has no plan. A point with an invalid
/// scenario is not counted: the claim is about points with a valid scenario.
///
/// Appends rows to `records` (SweepHeader) and reuses the rows that `records` already contains.
/// Rows are run in batches of 32. Rows that follow the verdict in the same batch are not counted.
///
/// Guarantees: the result does not depend on the number of jobs or on interruptions. Errors: those
/// of CheckVerifiable; InputError if the scenario has no expectations; RunError; InternalError for
/// a run that revealed a bug.
VerifyResult Verify(const CheckedStudy& checked, const VerifyClaim& claim, SweepRecords& records,
                    const VerifyOptions& options = {});

/// Returns the content of verify.json.
nlohmann::ordered_json ToJson(const VerifyResult& result, const VerifyClaim& claim);

/// Formats the conclusion as a sentence: "at least 0.99 of the runs pass, with 95 % confidence".
std::string ToText(const VerifyResult& result, const VerifyClaim& claim);

}  // namespace trackbed

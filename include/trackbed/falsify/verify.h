#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/analysis/sweep.h"
#include "trackbed/falsify/sequential_test.h"

/// Runs a sample of a study until the fraction of passing runs is known well enough to decide a
/// claim.
namespace trackbed {

struct VerifyClaim {
  double probability = 0.99;  ///< lower bound on the probability that a run passes; in (0, 1)
  double confidence = 0.95;   ///< in (0, 1)
};

struct VerifyOptions {
  int jobs = 1;                         ///< runs at the same time, at least 1
  std::function<bool()> interrupted{};  ///< asked before each run, by any thread
  std::function<void(double fraction)>
      progress{};  ///< fraction of the sample; called by one thread at a time
};

struct VerifyResult {
  ProbabilityVerdict verdict = ProbabilityVerdict::kUndecided;
  std::size_t runs = 0;     ///< until the verdict, without refused points
  std::size_t passed = 0;   ///< of these runs
  std::size_t refused = 0;  ///< points without a scenario, which are not counted
  bool interrupted = false;
};

/// InputError unless the study is a single grid point with a sample whose method is `random`: the
/// test needs independent trials, and points of other samples are not independent. InputError also
/// with `repeat` or `bisect`.
void CheckVerifiable(const StudyPoints& points);

/// Runs the rows of the sample in order until SequentialTest has a verdict or the sample is used
/// up. A run that does not pass is a failure, also one without a plan. A point without a scenario
/// is not counted: the claim is about the points that have one.
///
/// Appends rows to `records` (SweepHeader) and reuses rows that are already there. Runs in batches
/// of 32, so that a few rows may follow the verdict; they are not counted.
///
/// Guarantees: the same result for any number of jobs, interrupted or not. Errors: CheckVerifiable;
/// InputError when the scenario has no expectations; RunError; InternalError for a run that hit a
/// bug.
VerifyResult Verify(const CheckedStudy& checked, const VerifyClaim& claim, SweepRecords& records,
                    const VerifyOptions& options = {});

/// The content of verify.json.
nlohmann::ordered_json ToJson(const VerifyResult& result, const VerifyClaim& claim);

/// The conclusion in a sentence: "at least 0.99 of the runs pass, with 95 % confidence".
std::string ToText(const VerifyResult& result, const VerifyClaim& claim);

}  // namespace trackbed

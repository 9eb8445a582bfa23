#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/analysis/sweep.h"
#include "trackbed/falsify/sequential_test.h"

/// Runs a sample of a study until it is known whether enough of its runs pass.
namespace trackbed {

struct VerifyClaim {
  double probability = 0.99;  ///< that a run passes, at least; in (0, 1)
  double confidence = 0.95;   ///< in (0, 1)
};

struct VerifyOptions {
  int jobs = 1;                                     ///< runs at the same time, at least 1
  std::function<bool()> interrupted{};              ///< asked before each run, by any thread
  std::function<void(double fraction)> progress{};  ///< of the sample, by one thread at a time
};

struct VerifyResult {
  ProbabilityVerdict verdict = ProbabilityVerdict::kUndecided;
  std::size_t runs = 0;     ///< until the verdict, refused points not among them
  std::size_t passed = 0;   ///< of these
  std::size_t refused = 0;  ///< points without a scenario, which are left out
  bool interrupted = false;
};

/// InputError unless the study is one point of a grid with a sample whose method is `random`:
/// points of other samples are not independent, and the test is for independent trials. Likewise
/// with `repeat` or `bisect`.
void CheckVerifiable(const StudyPoints& points);

/// Runs the rows of the sample in their order until SequentialTest has a verdict or the sample is
/// at its end. A run fails that does not pass, also one without a plan. A point without a scenario
/// counts neither way: the claim is about the points that have one.
///
/// Appends rows to `records` (SweepHeader), and takes what is there. Runs in batches of 32, so that
/// there may be some rows beyond the verdict, which are not counted.
///
/// Guarantees: the same result for any number of jobs, interrupted or not. Errors: CheckVerifiable;
/// InputError when the scenario expects nothing; RunError; InternalError for a run that met a bug.
VerifyResult Verify(const CheckedStudy& checked, const VerifyClaim& claim, SweepRecords& records,
                    const VerifyOptions& options = {});

/// verify.json.
nlohmann::ordered_json ToJson(const VerifyResult& result, const VerifyClaim& claim);

/// What may be said, in a sentence: "at least 0.99 of the runs pass, with 95 % confidence".
std::string ToText(const VerifyResult& result, const VerifyClaim& claim);

}  // namespace trackbed

#include "trackbed/falsify/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/sweep_rows.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kVerifyBatch = 32;

/// Returns the run status of a row of the study.
std::string StatusOf(const SweepRecords& records, const SweepRow& row) {
  const std::vector<std::string> columns = records.Columns();
  const auto at = std::find(columns.begin(), columns.end(), "status") - columns.begin();
  return row.cells.at(static_cast<std::size_t>(at));
}

/// Runs the rows from `from` to `to` (exclusive) that have no recorded result yet. RunRows returns
/// false if the runs were interrupted.
bool RunRows(const CheckedStudy& checked, std::size_t from, std::size_t to, SweepRecords& records,
             const VerifyOptions& options) {
  std::vector<std::size_t> missing;
  for (std::size_t row = from; row < to; ++row) {
    if (!records.Has(row)) {
      missing.push_back(row);
    }
  }
  const RunScenarioOnce run = [&](const Scenario& scenario) -> std::optional<RunOutcome> {
    return options.interrupted && options.interrupted()
               ? std::nullopt
               : DriveOnce(checked, scenario, options.interrupted);
  };
  std::mutex mutex;
  std::size_t done = 0;
  ForEachIndex(missing.size(), options.jobs, [&](std::size_t i) {
    const std::size_t row = missing[i];
    const std::optional<SweepRow> made =
        MakeRow(checked.points.study(), run, checked.points.Read(row), 0);
    if (!made) {
      return false;
    }
    records.Append(row, ToJson(*made));
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress) {
      options.progress(static_cast<double>(from + done) /
                       static_cast<double>(checked.points.size()));
    }
    return true;
  });
  return done == missing.size();
}

}  // namespace

void CheckVerifiable(const StudyPoints& points) {
  const Study& study = points.study();
  const auto refuse = [&](const char* key, const char* message) {
    throw InputError(Problem{.file = study.file, .key = key, .message = message});
  };
  if (!study.sample) {
    refuse("sample", "missing; the probability is that of keys with distributions");
  }
  if (study.sample->method != SampleMethod::kRandom) {
    refuse("sample.method",
           "must be random: the points of other samples are not independent of each other");
  }
  if (study.bisect) {
    refuse("bisect", "each row must be one run; leave it out");
  }
  if (study.repeat > 1) {
    refuse("repeat", "runs of one point are not independent of each other; leave it out");
  }
  if (points.size() != static_cast<std::size_t>(study.sample->count)) {
    refuse("vary", "has lists of values: the probability would be that of a mixture of them");
  }
}

VerifyResult Verify(const CheckedStudy& checked, const VerifyClaim& claim, SweepRecords& records,
                    const VerifyOptions& options) {
  CheckVerifiable(checked.points);
  TRACKBED_REQUIRE(options.jobs > 0, "Verify: {} jobs", options.jobs);
  VerifyResult result;
  SequentialTest test(claim.probability, claim.confidence);
  const std::size_t rows = checked.points.size();
  for (std::size_t from = 0; from < rows && test.verdict() == ProbabilityVerdict::kUndecided;
       from += kVerifyBatch) {
    const std::size_t to = std::min(rows, from + kVerifyBatch);
    if (!RunRows(checked, from, to, records, options)) {
      result.interrupted = true;
      break;
    }
    for (std::size_t row = from; row < to && test.verdict() == ProbabilityVerdict::kUndecided;
         ++row) {
      const SweepRow made = ReadRow(records, row);
      TRACKBED_CHECK(!made.error, "row {}: {}", row, made.cells.back());
      if (StatusOf(records, made) == "driven") {
        throw InputError(Problem{.file = checked.points.study().scenario.string(),
                                 .key = "expect",
                                 .message = "a verification needs a scenario that expects "
                                            "something"});
      }
      if (made.refused) {
        ++result.refused;
      } else {
        test.Add(made.passed);
      }
    }
  }
  result.verdict = test.verdict();
  result.runs = test.trials();
  result.passed = test.successes();
  return result;
}

ordered_json ToJson(const VerifyResult& result, const VerifyClaim& claim) {
  const char* verdict = result.interrupted                               ? "interrupted"
                        : result.verdict == ProbabilityVerdict::kAtLeast ? "at_least"
                        : result.verdict == ProbabilityVerdict::kBelow   ? "below"
                                                                         : "undecided";
  return {{"verdict", verdict},
          {"probability", claim.probability},
          {"confidence", claim.confidence},
          {"method", "mixture of sequential probability ratio tests (Robbins 1970)"},
          {"runs", result.runs},
          {"passed", result.passed},
          {"refused", result.refused}};
}

std::string ToText(const VerifyResult& result, const VerifyClaim& claim) {
  const std::string counts = fmt::format("{} of {} runs passed", result.passed, result.runs);
  switch (result.verdict) {
    case ProbabilityVerdict::kAtLeast:
      return fmt::format("a run passes with a probability of at least {}, at {} % confidence: {}",
                         claim.probability, 100.0 * claim.confidence, counts);
    case ProbabilityVerdict::kBelow:
      return fmt::format("a run passes with a probability below {}, at {} % confidence: {}",
                         claim.probability, 100.0 * claim.confidence, counts);
    case ProbabilityVerdict::kUndecided:
      break;
  }
  return fmt::format(
      "not known whether a run passes with a probability of at least {}: {}, too "
      "few to tell at {} % confidence",
      claim.probability, counts, 100.0 * claim.confidence);
}

}  // namespace trackbed

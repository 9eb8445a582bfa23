#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// Test suites: many scenarios, each judged by its expectations.
namespace trackbed {

/// The outcome of one scenario of a suite.
enum class CaseStatus {
  kPassed,
  kFailed,     ///< The scenario ran and failed its expectations.
  kNotJudged,  ///< The scenario ran, but has no expectations.
  /// The scenario, its car or the environment is invalid. Nothing was simulated.
  kBadInput,
  kInternalError,  ///< The run revealed a bug in Trackbed.
  kInterrupted,    ///< The caller stopped the case, before or during its run.
};

/// One scenario of a suite.
struct SuiteCase {
  std::filesystem::path file;
  std::string name;  ///< Name of the scenario, or of its file if it could not be read.
  CaseStatus status = CaseStatus::kInterrupted;
  std::vector<std::string> reasons;  ///< Failures or problems, one line each.
  std::vector<std::string> notes;    ///< Notes of the verdict.
  double wall_time = 0.0;            ///< Wall-clock time of the case [s].
};

struct SuiteOptions {
  int jobs = 1;  ///< Number of scenarios at the same time, at least 1.
  /// Called with each finished case, in the order of the files, whatever the number of jobs. Only
  /// one thread calls `finished` at a time.
  std::function<void(const SuiteCase&)> finished;
  /// Returns whether to stop; called once per control period, by any thread.
  std::function<bool()> interrupted;
};

/// Reads, plans, simulates and judges every file. The function `read` reads a scenario from a file
/// and is called by any thread. An exception of `read` or of a run becomes the reason of its case
/// and does not affect other cases.
///
/// Guarantees: the cases are in the order of the files. Only `wall_time` depends on `jobs`.
/// InternalError unless jobs is positive.
std::vector<SuiteCase> RunSuite(const std::vector<std::filesystem::path>& files,
                                const std::function<Scenario(const std::filesystem::path&)>& read,
                                const SuiteOptions& options);

/// Formats the cases as JUnit XML for Jenkins and GitLab: one `testsuite` in `testsuites`, and a
/// `testcase` for each file. A `testcase` has `name`, `classname` (the folder, with dots), `file`
/// and `time` [s]. A case that did not pass has one `failure`, `error` or `skipped` (interrupted).
/// The message of the `failure`, `error` or `skipped` element is the first reason; the text of the
/// element contains all reasons. The notes of a case are in `system-out`. Characters that XML does
/// not allow become '?'.
std::string ToJUnit(const std::vector<SuiteCase>& cases);

}  // namespace trackbed

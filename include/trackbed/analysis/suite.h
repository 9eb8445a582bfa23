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
  kFailed,     ///< The scenario was run and did not meet its expectations.
  kNotJudged,  ///< The scenario was run, but has no expectations.
  /// The scenario, the scenario's car, or the environment of the program is invalid. Nothing was
  /// simulated.
  kBadInput,
  kInternalError,  ///< The run revealed a bug in Trackbed.
  kInterrupted,    ///< The caller stopped the suite before this case had finished.
};

/// One scenario of a suite, with its outcome.
struct SuiteCase {
  std::filesystem::path file;
  std::string name;  ///< Name of the scenario; name of the file if the scenario could not be read.
  CaseStatus status = CaseStatus::kInterrupted;
  std::vector<std::string> reasons;  ///< Failed checks or problems, one line each.
  std::vector<std::string> notes;    ///< Notes that the verdict contains.
  double wall_time = 0.0;            ///< Wall-clock time that the case took [s].
};

struct SuiteOptions {
  int jobs = 1;  ///< Number of scenarios that run at the same time, at least 1.
  /// Receives each finished case, in the order of the files for any number of jobs. Only one thread
  /// calls `finished` at a time.
  std::function<void(const SuiteCase&)> finished;
  /// Returns true to stop the suite; called once per control period, by any thread.
  std::function<bool()> interrupted;
};

/// Reads, plans, simulates and judges the scenario of every file. The function `read` reads a
/// scenario from a file and is called by any thread. If `read` or a run throws an exception, the
/// exception becomes the reason of the affected case; the other cases still run.
///
/// Guarantees: the cases are in the order of the files. Of all results, only `wall_time` depends on
/// `jobs`. Throws InternalError unless `jobs` is positive.
std::vector<SuiteCase> RunSuite(const std::vector<std::filesystem::path>& files,
                                const std::function<Scenario(const std::filesystem::path&)>& read,
                                const SuiteOptions& options);

/// Formats the cases as JUnit XML for Jenkins and GitLab: one `testsuite` in `testsuites`, and a
/// `testcase` for each file. A `testcase` has `name`, `classname` (the folder, with dots), `file`
/// and `time` [s]. A case that did not pass has one element `failure`, `error` or `skipped`
/// (interrupted). The message of the `failure`, `error` or `skipped` element is the first reason;
/// the text of the element contains all reasons. In the JUnit XML, the notes of a case are in
/// `system-out`. Characters that XML does not allow are replaced by '?'.
std::string ToJUnit(const std::vector<SuiteCase>& cases);

/// Returns the text with which each report of ToJUnit begins, and which other programs do not
/// write.
std::string JUnitBegin();

}  // namespace trackbed

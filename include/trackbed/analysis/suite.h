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
  kFailed,         ///< it ran and failed its expectations
  kNotJudged,      ///< it ran; the scenario has no expectations
  kBadInput,       ///< the scenario, its car or the environment is invalid: nothing was simulated
  kInternalError,  ///< a bug in Trackbed
  kInterrupted,    ///< the caller stopped it, before or during its run
};

/// One scenario of a suite.
struct SuiteCase {
  std::filesystem::path file;
  std::string name;  ///< the scenario's; the file's name if it could not be read
  CaseStatus status = CaseStatus::kInterrupted;
  std::vector<std::string> reasons;  ///< failures or problems, one line each
  std::vector<std::string> notes;    ///< of the verdict
  double wall_time = 0.0;            ///< [s]
};

struct SuiteOptions {
  int jobs = 1;  ///< scenarios at the same time, at least 1
  /// Called with each finished case, in the order of the files whatever `jobs` is, by one thread at
  /// a time.
  std::function<void(const SuiteCase&)> finished;
  std::function<bool()> interrupted;  ///< asked once per control period, by any thread
};

/// Reads, plans, simulates and judges every file. `read` makes a scenario of a file, on any thread;
/// exceptions from it or from the run become the reasons of that case and do not affect others.
///
/// Guarantees: cases in the order of the files; the result does not depend on `jobs`, except for
/// `wall_time`. InternalError unless jobs is positive.
std::vector<SuiteCase> RunSuite(const std::vector<std::filesystem::path>& files,
                                const std::function<Scenario(const std::filesystem::path&)>& read,
                                const SuiteOptions& options);

/// The cases as JUnit XML, as Jenkins and GitLab read it: one `testsuite` in `testsuites`, a
/// `testcase` for each file with `name`, `classname` (the folder, with dots), `file` and `time`
/// [s]. A case that did not pass has one `failure`, `error` or `skipped` (interrupted), with the
/// first reason as its message and all reasons as its text. Notes are in `system-out`. Characters
/// that XML cannot hold become '?'.
std::string ToJUnit(const std::vector<SuiteCase>& cases);

}  // namespace trackbed

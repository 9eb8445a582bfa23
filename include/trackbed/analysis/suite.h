#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// Many scenarios, each judged by what it expects itself: a test suite.
namespace trackbed {

/// The outcome of one scenario of a suite.
enum class CaseStatus {
  kPassed,
  kFailed,         ///< it ran and failed its expectations
  kNotJudged,      ///< it ran; the scenario has no expectations
  kBadInput,       ///< the scenario, its car or the environment is invalid: nothing was simulated
  kInternalError,  ///< a bug in Trackbed
  kInterrupted,    ///< the caller stopped it, or it was not begun
};

/// One scenario of a suite.
struct SuiteCase {
  std::filesystem::path file;
  std::string name;  ///< the scenario's; that of the file when it could not be read
  CaseStatus status = CaseStatus::kInterrupted;
  std::vector<std::string> reasons;  ///< failures or problems, one line each
  std::vector<std::string> notes;    ///< of the verdict
  double wall_time = 0.0;            ///< [s]
};

struct SuiteOptions {
  int jobs = 1;  ///< scenarios at the same time, at least 1
  /// Told of each finished case, in the order of the files whatever `jobs` is, by one thread at
  /// once.
  std::function<void(const SuiteCase&)> finished;
  std::function<bool()> interrupted;  ///< asked once per control period, by any thread
};

/// Reads, plans, drives and judges every file. `read` makes a scenario of a file, on any thread;
/// exceptions from it or from the run become the reasons of that case and do not affect others.
///
/// Guarantees: cases in the order of the files; but for `wall_time` the result does not depend on
/// `jobs`. InternalError unless jobs is positive.
std::vector<SuiteCase> RunSuite(const std::vector<std::filesystem::path>& files,
                                const std::function<Scenario(const std::filesystem::path&)>& read,
                                const SuiteOptions& options);

/// The cases as JUnit XML, as Jenkins and GitLab read it: one `testsuite` in `testsuites`, a
/// `testcase` for each file with `name`, `classname` (the folder, with dots), `file` and `time`
/// [s]; in it one `failure`, `error` or `skipped` (interrupted) whose message is the first reason
/// and whose text are all of them, and the notes as `system-out`. Characters that XML cannot hold
/// become '?'.
std::string ToJUnit(const std::vector<SuiteCase>& cases);

}  // namespace trackbed

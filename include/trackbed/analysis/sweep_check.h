#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "trackbed/analysis/run.h"
#include "trackbed/analysis/sweep_outputs.h"
#include "trackbed/scenario/study_points.h"

/// Checks a study before its runs, and drives its scenarios.
namespace trackbed {

/// The result of one run.
struct RunOutcome {
  /// Status of the run: "passed", "failed", "driven" (no expectations), or "no_plan".
  std::string status;
  bool passed = false;
  std::string reason{};  ///< Reason why the run failed or has no plan.
  Outputs outputs;
  /// Complete result of the run, if DriveOnce ran the scenario.
  std::optional<RunResult> result{};
};

/// Type of a function that runs a scenario, on any thread, and returns nullopt if the run was
/// interrupted.
using RunScenarioOnce = std::function<std::optional<RunOutcome>(const Scenario& scenario)>;

/// A study that has been validated as far as is possible without running its scenarios. A
/// CheckedStudy is immutable, so several threads may share a CheckedStudy.
struct CheckedStudy {
  StudyPoints points;
  std::unique_ptr<CarCache> cars;  ///< Cache of the compiled cars, never null.
  /// SHA-256 hashes of the study's input files, by file name.
  std::map<std::string, std::string> inputs;
};

/// Validates a study: reads its points (CheckPoints), compiles the cars, makes the plants and
/// checks the outputs. Throws InputError, listing all problems, if points or their cars are
/// invalid. Throws InputError if outputs are unknown, listing each of these outputs with the most
/// similar known path. If `all` is true, every point of the study must be valid; otherwise, one
/// valid point is enough.
CheckedStudy CheckStudy(Study study, bool all = true);

/// Plans, simulates, measures and judges a scenario of the study.
std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted = {});

}  // namespace trackbed

#pragma once

#include <filesystem>

#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"

namespace trackbed::cli {

/// Prints the result of a run, which was written to `folder`.
void PrintSummary(const RunResult& result, const std::filesystem::path& folder);

/// Prints each failure of a run to stderr, after the name of the scenario.
void PrintFailures(const RunResult& result);

/// Returns the exit code of a run: kInterrupted, kFailedExpectations or kOk.
ExitCode ExitCodeOf(const RunResult& result);

}  // namespace trackbed::cli

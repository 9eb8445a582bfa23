#pragma once

#include <CLI/CLI.hpp>
#include <atomic>

namespace trackbed::cli {

/// What a finished verb tells the shell; the contract's exit codes.
enum ExitCode {
  kOk = 0,
  kInternal = 1,
  kBadInput = 2,
  kFailedExpectations = 3,
  kInterrupted = 130,
};

/// Set by Ctrl-C; drives ask for it once per control period.
extern std::atomic<bool> interrupted;

/// A verb adds its options to `command` and sets what is to be done as its callback, which stores
/// the exit code in `exit_code`.
using AddVerb = void (*)(CLI::App& command, int& exit_code);

void AddRun(CLI::App& command, int& exit_code);
void AddPlan(CLI::App& command, int& exit_code);
void AddRender(CLI::App& command, int& exit_code);
void AddCheck(CLI::App& command, int& exit_code);
void AddCompare(CLI::App& command, int& exit_code);
void AddTest(CLI::App& command, int& exit_code);
void AddSweep(CLI::App& command, int& exit_code);
void AddReport(CLI::App& command, int& exit_code);
void AddExperiment(CLI::App& command, int& exit_code);
void AddList(CLI::App& command, int& exit_code);
void AddModel(CLI::App& command, int& exit_code);
void AddDocs(CLI::App& command, int& exit_code);

}  // namespace trackbed::cli

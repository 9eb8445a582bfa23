#pragma once

#include "src/cli/command.h"
#include "src/cli/interruption.h"

namespace trackbed::cli {

/// Exit codes of the program.
enum ExitCode {
  kOk = 0,
  kInternal = 1,
  kBadInput = 2,
  kFailedExpectations = 3,
  kInterrupted = 130,
};

/// Function that adds the options of a verb to `command` and sets the action of the verb.
using AddVerb = void (*)(const Command& command);

void AddRun(const Command& command);
void AddPlan(const Command& command);
void AddRender(const Command& command);
void AddImport(const Command& command);
void AddIdentify(const Command& command);
void AddCheck(const Command& command);
void AddCheckPath(const Command& command);
void AddCompare(const Command& command);
void AddTest(const Command& command);
void AddSweep(const Command& command);
void AddFalsify(const Command& command);
void AddVerify(const Command& command);
void AddReport(const Command& command);
void AddWatch(const Command& command);
void AddFmu(const Command& command);
void AddExperiment(const Command& command);
void AddList(const Command& command);
void AddModel(const Command& command);
void AddCompletion(const Command& command);
void AddDocs(const Command& command);
void AddManual(const Command& command);

// Each of the following functions adds a subcommand to the verb `sweep`.
void AddSweepMerge(const Command& command);
void AddSweepSubmit(const Command& command);

}  // namespace trackbed::cli

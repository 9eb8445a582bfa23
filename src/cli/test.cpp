#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <thread>

#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/suite.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct TestOptions {
  std::vector<std::string> paths;
  std::string junit;
  int jobs = 0;  // 0: as many as the machine runs threads
  ScenarioOptions scenario;
};

void PrintCase(const SuiteCase& one, bool quiet) {
  std::string line = one.status == CaseStatus::kPassed ? "all expectations met"
                     : one.status == CaseStatus::kNotJudged
                         ? "no expectations"
                         : fmt::format("{}", fmt::join(one.reasons, "; "));
  for (const std::string& note : one.notes) {
    line += "; " + note;
  }
  switch (one.status) {
    case CaseStatus::kPassed:
      if (!quiet) {
        fmt::print("pass {}: {}\n", one.file.string(), line);
      }
      break;
    case CaseStatus::kNotJudged:
      if (!quiet) {
        fmt::print("not judged {}: {}\n", one.file.string(), line);
      }
      break;
    case CaseStatus::kFailed:
      fmt::print("FAIL {}: {}\n", one.file.string(), line);
      break;
    case CaseStatus::kBadInput:
    case CaseStatus::kInternalError:
      fmt::print(stderr, "{}\n", fmt::join(one.reasons, "\n"));
      break;
    case CaseStatus::kInterrupted:
      break;
  }
  std::fflush(stdout);  // lines come as they are known, in a pipe too
}

/// A bug outranks everything; bad input outranks a failed expectation: the suite did not say what
/// it was to say.
int SuiteExitCode(const std::vector<SuiteCase>& cases) {
  const auto any = [&](CaseStatus status) {
    return std::any_of(cases.begin(), cases.end(),
                       [&](const SuiteCase& one) { return one.status == status; });
  };
  return any(CaseStatus::kInternalError) ? kInternal
         : any(CaseStatus::kInterrupted) ? kInterrupted
         : any(CaseStatus::kBadInput)    ? kBadInput
         : any(CaseStatus::kFailed)      ? kFailedExpectations
                                         : kOk;
}

int Test(const TestOptions& options) {
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const std::vector<fs::path> files = ScenarioFiles(options.paths, FolderContent::kScenarios);
  if (!options.junit.empty()) {  // before the work, not after it
    PrepareToWrite(options.junit);
  }
  const std::vector<SuiteCase> cases =
      RunSuite(files,
               [&](const fs::path& file) {
                 RefuseFolder(file);
                 return options.scenario.Read(file);
               },
               {.jobs = options.jobs > 0 ? options.jobs : threads,
                .finished = [&](const SuiteCase& one) { PrintCase(one, options.scenario.quiet); },
                .interrupted = [] { return interrupted.load(); }});
  if (!options.junit.empty()) {
    WriteFileAtomically(options.junit, ToJUnit(cases));
  }
  return SuiteExitCode(cases);
}

}  // namespace

void AddTest(const Command& command) {
  const auto options = std::make_shared<TestOptions>();
  command.AddPositional("paths", options->paths, "Scenario files, or folders searched recursively")
      .Required()
      .TypeName("PATH...");
  command.AddOption("--junit", options->junit, "Also write the results as JUnit XML")
      .TypeName("FILE");
  command
      .AddOption("-j,--jobs", options->jobs,
                 "Scenarios to run in parallel (default: one per hardware thread)")
      .Range(1, 1000)
      .TypeName("N");
  options->scenario.AddTo(command);
  command.OnRun([options] { return Test(*options); });
}

}  // namespace trackbed::cli

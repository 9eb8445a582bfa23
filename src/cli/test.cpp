#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/suite.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct TestOptions {
  std::vector<std::string> paths;
  std::string junit;
  int jobs = 0;  // number of scenarios that run in parallel; 0: one per hardware thread
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
        Print("{} {} ({:.1f} s): {}\n", Colorize(Tone::kGood, "pass"), one.file.string(),
              one.wall_time, line);
      }
      break;
    case CaseStatus::kNotJudged:
      if (!quiet) {
        Print("{} {} ({:.1f} s): {}\n", Colorize(Tone::kDoubtful, "not judged"), one.file.string(),
              one.wall_time, line);
      }
      break;
    case CaseStatus::kFailed:
      Print("{} {} ({:.1f} s): {}\n", Colorize(Tone::kBad, "FAIL"), one.file.string(),
            one.wall_time, line);
      break;
    case CaseStatus::kBadInput:
    case CaseStatus::kInternalError:
      PrintTo(stderr, "{}\n",
              Colorize(Tone::kBad, Lines{fmt::format("{}", fmt::join(one.reasons, "\n"))}, stderr));
      break;
    case CaseStatus::kInterrupted:
      break;
  }
  std::fflush(stdout);  // flush stdout, so that each line appears at once, even if stdout is a pipe
}

/// Returns the exit code of a test suite. An internal error takes precedence over bad input, and
/// bad input takes precedence over failed expectations. Bad input takes precedence because
/// scenarios with bad input are not run, so the suite's result is incomplete.
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

/// Prints a summary line such as "12 scenarios in 34.5 s: 10 passed, 1 failed, 1 not judged".
void PrintTotal(const std::vector<SuiteCase>& cases, double wall_time) {
  struct Count {
    CaseStatus status;
    const char* name;
    Tone tone;
  };
  static constexpr std::array kCounts{
      Count{CaseStatus::kPassed, "passed", Tone::kGood},
      Count{CaseStatus::kFailed, "failed", Tone::kBad},
      Count{CaseStatus::kNotJudged, "not judged", Tone::kDoubtful},
      Count{CaseStatus::kBadInput, "with wrong input", Tone::kBad},
      Count{CaseStatus::kInternalError, "with internal errors", Tone::kBad},
      Count{CaseStatus::kInterrupted, "not finished", Tone::kDoubtful},
  };
  std::vector<SafeText> parts;
  for (const Count& count : kCounts) {
    const auto number = std::count_if(cases.begin(), cases.end(), [&](const SuiteCase& one) {
      return one.status == count.status;
    });
    if (number > 0) {
      parts.push_back(Colorize(count.tone, fmt::format("{} {}", number, count.name)));
    }
  }
  Print("{} scenario{} in {}: {}\n", cases.size(), cases.size() == 1 ? "" : "s",
        DurationText(wall_time), Joined(parts, ", "));
}

int Test(const TestOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const std::vector<fs::path> files = ScenarioFiles(options.paths, FolderContent::kScenarios);
  if (!options.junit.empty()) {
    PrepareOutputFile("--junit", options.junit, files, BeginsWith(JUnitBegin()));
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
  if (!options.scenario.quiet) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    PrintTotal(cases, took.count());
  }
  return SuiteExitCode(cases);
}

}  // namespace

void AddTest(const Command& command) {
  const auto options = std::make_shared<TestOptions>();
  command.AddPositional("paths", options->paths, "Scenario files, or folders searched recursively")
      .Required()
      .TypeName("SCENARIO...");
  command.AddOption("--junit", options->junit, "Also write the results as JUnit XML")
      .TypeName("FILE");
  AddJobs(command, options->jobs, "Scenarios to run in parallel");
  options->scenario.AddTo(command);
  command.AddExample("Two shipped scenarios, with results for a CI server",
                     "trackbed test three_turns paper_circle --junit results.xml");
  command.OnRun([options] { return Test(*options); });
}

}  // namespace trackbed::cli

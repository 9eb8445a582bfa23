#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

int TestOne(const std::filesystem::path& file, const ScenarioOptions& options) {
  try {
    const Scenario scenario = options.Read(file);
    const RunResult run = RunMission(
        scenario, {.drive = [](const std::string&) {
          return DriveHooks{.progress = {}, .interrupted = [] { return interrupted.load(); }};
        }});
    if (run.interrupted) {
      return kInterrupted;
    }
    if (!run.verdict.passed || !options.quiet) {
      std::string line = run.verdict.passed
                             ? "as expected"
                             : fmt::format("{}", fmt::join(run.verdict.failures, "; "));
      for (const std::string& note : run.verdict.notes) {
        line += "; " + note;
      }
      fmt::print("{} {}: {}\n", run.verdict.passed ? "pass" : "FAIL", file.string(), line);
    }
    return run.verdict.passed ? kOk : kFailedExpectations;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  }
}

}  // namespace

void AddTest(CLI::App& command, int& exit_code) {
  struct Options {
    std::vector<std::string> paths;
    ScenarioOptions scenario;
  };
  const auto options = std::make_shared<Options>();
  command.add_option("paths", options->paths, "Scenario files, or folders of them")
      ->required()
      ->type_name("PATH...");
  options->scenario.AddTo(command);
  command.callback([options, &exit_code] {
    // Bad input outranks a failed expectation: the suite did not say what it was to say.
    bool failed = false;
    bool bad = false;
    for (const auto& file : ScenarioFiles(options->paths)) {
      const int code = TestOne(file, options->scenario);
      if (code == kInterrupted) {
        exit_code = kInterrupted;
        return;
      }
      failed = failed || code == kFailedExpectations;
      bad = bad || code == kBadInput;
    }
    exit_code = bad ? kBadInput : failed ? kFailedExpectations : kOk;
  });
}

}  // namespace trackbed::cli

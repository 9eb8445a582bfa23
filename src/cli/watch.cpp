#include "trackbed/watch/watch.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/run_summary.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct WatchVerbOptions {
  std::string what;
  std::string out;
  std::string host = WatchOptions{}.host;
  int port = WatchOptions{}.port;
  std::optional<std::string> speed;
  bool paused = false;
  ScenarioOptions scenario;
};

WatchOptions OptionsOf(const WatchVerbOptions& options) {
  const std::optional<double> speed = ParseSpeed(options.speed.value_or("1"));
  if (!speed) {
    throw InputError(Problem{
        .key = "--speed",
        .message = fmt::format("'{}' must be a number from 0.01 to 1000, or max", *options.speed)});
  }
  return {.host = options.host, .port = options.port, .speed = *speed, .paused = options.paused};
}

WatchHooks Hooks() {
  return {.serving =
              [](const std::string& url) {
                Print("{}  (Ctrl-C ends)\n", url);
                if (std::fflush(stdout) != 0) {
                  throw RunError("cannot write the address of the page to standard output");
                }
              },
          .interrupted = [] { return interrupted.load(); },
          .finished = {}};
}

/// Rejects scenario options, because the options of a finished run cannot be changed.
void RejectScenarioOptions(const WatchVerbOptions& options) {
  const ScenarioOptions& scenario = options.scenario;
  const bool any = options.speed || options.paused || !options.out.empty() ||
                   !scenario.plants.empty() || !scenario.overrides.empty() ||
                   !scenario.seed.empty() || !scenario.asset_folders.empty();
  if (any) {
    throw InputError(
        Problem{.file = options.what,
                .message = "is a finished result, which takes only --host, --port and --quiet"});
  }
}

int Watch(const WatchVerbOptions& options) {
  const fs::path what = options.what;
  const WatchOptions watch = OptionsOf(options);
  WatchHooks hooks = Hooks();
  if (fs::is_directory(what) || what.extension() == ".csv") {
    RejectScenarioOptions(options);
    WatchReport({what}, watch, hooks);
    return kOk;
  }
  const ScenarioRun run = ReadScenarioRuns({options.what}, options.scenario, options.out, "out")[0];
  const CarModel& car = *run.car;  // the reader loads the car of a single scenario
  const OutputFolder folder(run.folder);
  hooks.finished = [&](const RunResult& result) {
    if (options.scenario.quiet) {
      PrintFailures(result);
    } else {
      PrintSummary(result, run.folder);
    }
  };
  return ExitCodeOf(WatchRun(run.scenario, car, folder, watch, hooks));
}

}  // namespace

void AddWatch(const Command& command) {
  const auto options = std::make_shared<WatchVerbOptions>();
  command
      .AddPositional("what", options->what,
                     "Scenario file to run, or the folder of a finished run, comparison or study")
      .Required()
      .TypeName("SCENARIO");
  command
      .AddOption("--speed", options->speed,
                 "Simulated seconds per second, 0.01 to 1000, or max: as fast as possible "
                 "(default: 1); the page can change it")
      .TypeName("SPEED");
  command.AddFlag("--paused", options->paused, "Wait at the start until the page resumes the run");
  command.AddOption("--port", options->port, "Port to listen on (default: any that is free)")
      .Range(0, 65535)
      .TypeName("N");
  command
      .AddOption("--host", options->host,
                 "IP address to listen at; 0.0.0.0 lets every machine that reaches this one watch "
                 "and control the run")
      .TypeName("ADDRESS")
      .ShowDefault();
  command.AddOption("-o,--out", options->out, "Output folder of the run (default: out/<scenario>)")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.AddExample("Watch a shipped scenario in real time; open the address that is printed",
                     "trackbed watch three_turns");
  command.AddExample("Wait for the page, then run at five times real time",
                     "trackbed watch three_turns --paused --speed 5");
  command.AddExample("The page of a finished run", "trackbed watch out/three_turns");
  command.OnRun([options] { return Watch(*options); });
}

}  // namespace trackbed::cli

#include "trackbed/analysis/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>

#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct SweepVerbOptions {
  std::string file;
  std::string out;
  int jobs = 0;  // 0: as many as the machine runs threads
  ScenarioOptions scenario;
};

int Sweep(const SweepVerbOptions& options) {
  const CheckedStudy checked =
      CheckStudy(options.scenario.ReadStudyFile(options.file), BadPoints::kKeep);
  const std::string& name = checked.study.name;
  const fs::path out = options.out.empty() ? fs::path("out") / name : fs::path(options.out);
  const OutputFolder folder(out);  // before the work, not after it

  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto is_interrupted = [] { return interrupted.load(); };
  const SweepResult sweep = [&] {
    ProgressBar bar(name, options.scenario.quiet);
    return RunSweep(
        checked.study, checked.points,
        [&](const Scenario& scenario) { return DriveOnce(checked, scenario, is_interrupted); },
        {.jobs = options.jobs > 0 ? options.jobs : threads,
         .progress = [&](double fraction) { bar.Show(fraction); },
         .interrupted = is_interrupted});
  }();
  WriteSweep(sweep, folder);
  if (!options.scenario.quiet) {
    const std::size_t rows = sweep.table.rows().size();
    const std::string how =
        sweep.complete()
            ? fmt::format("{} rows from {} runs, {} passed", rows, sweep.runs, sweep.passed)
            : fmt::format("interrupted after {} of {} rows", rows, sweep.rows_expected);
    fmt::print("{}: {}, in {}\n", name, how, (out / run_folder::kSweepCsv).string());
  }
  if (sweep.refused + sweep.errors > 0) {
    fmt::print(stderr,
               "{}: {} rows without a run: {} refused, {} with an internal error; see the "
               "column reason\n",
               name, sweep.refused + sweep.errors, sweep.refused, sweep.errors);
  }
  return sweep.errors > 0 ? kInternal : sweep.complete() ? kOk : kInterrupted;
}

}  // namespace

void AddSweep(const Command& command) {
  const auto options = std::make_shared<SweepVerbOptions>();
  command.AddPositional("study", options->file, "Study file").Required().TypeName("STUDY");
  command
      .AddOption("-j,--jobs", options->jobs, "Runs in parallel (default: one per hardware thread)")
      .Range(1, 1000)
      .TypeName("N");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<study>)")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.OnRun([options] { return Sweep(*options); });
}

}  // namespace trackbed::cli

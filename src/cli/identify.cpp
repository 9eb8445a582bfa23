#include "trackbed/identify/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/identify/identify_files.h"
#include "trackbed/report/report.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct IdentifyOptions {
  std::string study;
  std::string out;
  int jobs = 0;
  std::vector<std::string> asset_folders;
  bool report = false;
  bool quiet = false;
};

std::string InWords(ParameterStatus status) {
  switch (status) {
    case ParameterStatus::kIdentified:
      return "";
    case ParameterStatus::kAtLowerBound:
      return "at its lower bound";
    case ParameterStatus::kAtUpperBound:
      return "at its upper bound";
    case ParameterStatus::kNotIdentified:
      return "not identified";
    case ParameterStatus::kUnfinished:
      return "not finished";
  }
  return "";
}

void PrintParameters(const IdentificationResult& result) {
  Print("  {:<24} {:>11} {:>11} {:>14}\n", "parameter", "start", "estimate", "standard error");
  for (const ParameterEstimate& estimate : result.parameters) {
    const bool known = estimate.status != ParameterStatus::kNotIdentified;
    std::string remark = InWords(estimate.status);
    if (!estimate.remark.empty()) {
      remark += (remark.empty() ? "" : ": ") + estimate.remark;
    }
    Print("  {:<24} {:>11.4g} {:>11} {:>14}{}{}\n", estimate.parameter.name, estimate.start,
          known ? fmt::format("{:.4g}", estimate.value) : "",
          estimate.standard_error ? fmt::format("{:.2g}", *estimate.standard_error) : "",
          remark.empty() ? "" : "  ", Colorize(Tone::kDoubtful, remark));
  }
}

const PlantMetrics* Find(const RunResult& run, const std::string& plant) {
  for (const PlantMetrics& metrics : run.metrics) {
    if (metrics.plant == plant && metrics.recorded) {
      return &metrics;
    }
  }
  return nullptr;
}

void PrintRecords(const IdentificationResult& result) {
  Print("  {:<26} {:<14} {:>21}  after {:.3g} s: median, 90 %\n", "record", "plant",
        "yaw rate (rel. rms)", result.study.horizon);
  for (const IdentifiedRecord& record : result.records) {
    for (const PlantMetrics& fitted : record.fitted.metrics) {
      const PlantMetrics* start = Find(record.start, fitted.plant);
      if (start == nullptr || !fitted.recorded) {
        continue;
      }
      std::string windows;
      for (const WindowErrors& window : fitted.windows) {
        if (window.horizon == result.study.horizon && window.count > 0) {
          windows = fmt::format("{:.3g} m, {:.3g} m", window.position_median, window.position_p90);
        }
      }
      Print("  {:<26} {:<14} {:>9.3g} -> {:<8.3g}  {}{}\n", record.name, fitted.plant,
            start->recorded->yaw_rate_relative_rms, fitted.recorded->yaw_rate_relative_rms, windows,
            record.held_out ? "  (held out)" : "");
    }
  }
}

int RunIdentification(const IdentifyOptions& options) {
  const Identification study = ReadIdentification(options.study, Paths(options.asset_folders));
  const fs::path out = OutputFolderOf(options.out, study.name);
  // Lock the output folder before the estimation, so that a locking error appears before the long
  // computation.
  const OutputFolder folder(out, IdentificationFiles(study));
  for (const auto* list : {&study.fit_scenarios, &study.held_out_scenarios}) {
    for (const Scenario& scenario : *list) {
      RequireNoForeignFiles(RecordFolder(out, scenario.name), run_folder::AllNames());
    }
  }
  ProgressBar bar(study.name, options.quiet);
  const IdentificationResult result = Identify(
      study, {.progress = [&](double fraction) { bar.Show(fraction); },
              .interrupted = [] { return interrupted.load(); },
              .threads = options.jobs > 0 ? options.jobs
                                          : static_cast<int>(std::max(
                                                1U, std::thread::hardware_concurrency()))});
  bar.Show(1.0);
  WriteIdentification(result, folder);
  if (options.report) {
    WriteReport({out}, out / run_folder::kReport);
  }
  if (!options.quiet) {
    Print("{}: {}, cost {:.4g} -> {:.4g} over {} windows of {:.3g} s, in {}\n", study.name,
          result.interrupted ? Colorize(Tone::kDoubtful, "interrupted") : SafeText{"finished"},
          result.start_cost, result.cost, result.windows, study.horizon, out.string());
    for (const std::string& note : result.notes) {
      Print("  {}\n", Colorize(Tone::kDoubtful, note));
    }
    PrintParameters(result);
    PrintRecords(result);
  }
  return result.interrupted ? kInterrupted : kOk;
}

}  // namespace

void AddIdentify(const Command& command) {
  const auto options = std::make_shared<IdentifyOptions>();
  command
      .AddPositional("study", options->study,
                     "What to estimate from which recorded drives: an identification file")
      .Required()
      .TypeName("STUDY");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<name>)")
      .TypeName("DIR");
  AddJobs(command, options->jobs, "Windows simulated in parallel");
  AddAllowAssets(command, options->asset_folders);
  command.AddFlag("--report", options->report, "Also write report.html in the folder");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("Fit the tyres of the 1:10 car to its recordings",
                     "trackbed identify scenarios/real/identify_single_track.yaml --report");
  command.OnRun([options] { return RunIdentification(*options); });
}

}  // namespace trackbed::cli

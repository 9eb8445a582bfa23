#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "src/cli/output_file.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/compare_runs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::vector<std::string> files;
  std::vector<std::string> tolerances;
  std::string out;
  ScenarioOptions scenario;
};

void PrintRow(const char* what, const char* unit, const Difference& difference,
              const std::optional<double>& tolerance) {
  std::string max = fmt::format("{:.3g}", difference.max);
  std::string limit = tolerance ? fmt::format("; at most {:.4g}", *tolerance) : "";
  SafeText exceeded;
  if (tolerance && !(difference.max <= *tolerance)) {
    const auto [expected, actual] = FormatDistinct(*tolerance, difference.max);
    max = actual;
    limit = "; at most " + expected + ": ";
    exceeded = Colorize(Tone::kBad, "EXCEEDED");
  }
  Print("    {:<8} {:>9} {:<5} at {:>6.4g} m, {:>6.4g} s; rms {:>9.3g} {}{}{}\n", what, max, unit,
        difference.max_s, difference.max_t, difference.rms, unit, limit, exceeded);
}

SafeText StatusText(const RunComparison& result) {
  return !result.verdict.passed ? Colorize(Tone::kBad, "FAILED")
         : result.judged()      ? Colorize(Tone::kGood, "passed")
                                : SafeText{"compared, no tolerances given"};
}

void PrintComparison(const std::string& name, const RunComparison& result, const fs::path& out) {
  Print("{}: {}, in {}\n", name, StatusText(result), (out / run_folder::kCompareJson).string());
  for (const ComparedPair& pair : result.pairs) {
    const PlantComparison& c = pair.comparison;
    if (!c.comparable()) {
      // Skip this pair of plants (car models), because the verdict already reports that the plants
      // are not comparable.
      continue;
    }
    Print("  {} - {}, from {:.4g} m to {:.4g} m\n", c.first, c.second, c.from_s, c.to_s);
    for (const ComparedQuantity& quantity : ComparedQuantities()) {
      PrintRow(quantity.name, quantity.unit, c.*quantity.difference, pair.bounds.*quantity.bound);
    }
  }
  for (const auto& lines : {result.verdict.failures, result.verdict.notes}) {
    for (const std::string& line : lines) {
      Print("  {}\n", line);
    }
  }
}

int Finish(const std::string& name, const RunComparison& result, const fs::path& out, bool quiet) {
  if (!quiet) {
    PrintComparison(name, result, out);
  }
  return result.verdict.passed ? kOk : kFailedExpectations;
}

std::optional<DifferenceBounds> Tolerances(const CompareOptions& options) {
  return options.tolerances.empty() ? std::optional<DifferenceBounds>()
                                    : ParseTolerances(options.tolerances);
}

int CompareFinished(const CompareOptions& options) {
  if (!options.scenario.overrides.empty() || !options.scenario.seed.empty()) {
    throw InputError(
        Problem{.message = "--set and --seed apply to scenarios, not to finished runs"});
  }
  const std::vector<fs::path> folders(options.files.begin(), options.files.end());
  const RunComparison result =
      CompareFolders(folders, options.scenario.plants, Tolerances(options));
  const OutputFolder out(OutputFolderOf(options.out, "compare"));
  WriteComparison(result, out);
  return Finish(fmt::format("{}", fmt::join(options.files, " and ")), result, out.path(),
                options.scenario.quiet);
}

int CompareScenario(const ScenarioRun& run, const CompareOptions& options) {
  const auto [folder, result, finishing] = DriveScenario(run, options.scenario.quiet);
  if (result.interrupted) {
    WriteRunFolder(result, folder);
    if (!options.scenario.quiet) {
      Print("{}: interrupted, in {}\n", run.scenario.name, run.folder.string());
    }
    return kInterrupted;
  }
  const RunComparison comparison = CompareRun(result, Tolerances(options));
  ResultWriter writer(folder);
  AddRunFolder(result, writer);
  AddComparison(comparison, folder.path(), writer);
  writer.Commit();
  return Finish(run.scenario.name, comparison, folder.path(), options.scenario.quiet);
}

int CompareScenarios(const CompareOptions& options) {
  // Check the given tolerances before the runs, so that the user sees an error in them at once.
  static_cast<void>(Tolerances(options));
  const std::vector<ScenarioRun> runs =
      ReadScenarioRuns(options.files, options.scenario, options.out, "out/compare");
  for (const ScenarioRun& run : runs) {
    if (run.scenario.drive.plants.size() < 2) {
      throw InputError(Problem{
          .key = run.scenario.name + ": drive.plants",
          .message =
              fmt::format("only {}; comparing needs two plants, such as --plants kinematic,mujoco",
                          run.scenario.drive.plants.front())});
    }
  }
  return ForEachRun(runs, [&](const ScenarioRun& run) { return CompareScenario(run, options); });
}

int Compare(const CompareOptions& options) {
  const auto folders =
      std::count_if(options.files.begin(), options.files.end(),
                    [](const std::string& file) { return fs::is_directory(file); });
  if (folders == 0) {
    return CompareScenarios(options);
  }
  if (folders != static_cast<std::ptrdiff_t>(options.files.size()) || folders > 2) {
    throw InputError(
        Problem{.message = "give scenario files or one or two folders of finished runs, not both"});
  }
  return CompareFinished(options);
}

}  // namespace

void AddCompare(const Command& command) {
  const auto options = std::make_shared<CompareOptions>();
  command
      .AddPositional("files", options->files,
                     "Scenario files, or one or two folders of finished runs")
      .Required()
      .TypeName("SCENARIO...");
  command
      .AddOption("--plants", options->scenario.plants,
                 "Plants to compare (default: all of the scenario or run, or those common to both "
                 "runs); with two runs, A,B compares A of the first with B of the second")
      .Delimiter(',')
      .OneWord()
      .TypeName("PLANT,...");
  command
      .AddOption("--tolerance", options->tolerances,
                 "Tolerances on position [m], heading [rad], yaw_rate [rad/s], steering [rad] "
                 "(default: expect.between of the scenario; none for two runs)")
      .Delimiter(',')
      .OneWord()
      .TypeName("NAME=VALUE,...");
  command
      .AddOption("-o,--out", options->out,
                 "Output folder (default: out/compare/<scenario>, or out/compare for finished "
                 "runs); with several scenarios, one subfolder each")
      .TypeName("DIR");
  options->scenario.AddKeysTo(command);
  command.AddExample("How far the car in MuJoCo is from the kinematic one on the same plan",
                     "trackbed compare three_turns --tolerance position=0.1");
  command.AddExample("Two finished runs", "trackbed compare out/three_turns out/three_turns");
  command.OnRun([options] { return Compare(*options); });
}

}  // namespace trackbed::cli

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/report/report.h"
#include "trackbed/scenario/record.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct ImportOptions {
  std::string log;
  std::string map;
  std::string out;
  std::string vehicle = VehicleSpec{}.model;
  std::vector<std::string> asset_folders;
  bool align = false;
  bool report = false;
  bool mcap = false;
  bool quiet = false;
};

void PrintImport(const RunResult& result, const fs::path& out) {
  const RecordedDrive& drive = *result.scenario.record->data;
  const PlantMetrics& metrics = result.metrics.front();
  Print("{}: {:.4g} s, {:.4g} m, {:.3g} % valid, in {}\n", result.scenario.name, drive.duration(),
        metrics.distance, 100.0 * drive.valid_fraction(), out.string());
  for (const std::string& note : drive.notes) {
    Print("  {}\n", note);
  }
}

int Import(const ImportOptions& options) {
  LogMap map = ReadLogMap(options.map);
  map.align = map.align || options.align;
  auto drive = std::make_shared<const RecordedDrive>(ImportLog(options.log, map));
  Scenario scenario = RecordScenario(std::move(drive), options.vehicle);
  scenario.asset_folders = Paths(options.asset_folders);
  CheckScenario(scenario);
  const fs::path out =
      options.out.empty() ? fs::path("out") / scenario.name : fs::path(options.out);
  const auto [folder, result, finishing] = DriveScenario({scenario, out}, options.quiet);
  WriteRunFolder(result, folder, {.mcap = options.mcap});
  if (options.report && !result.interrupted) {
    WriteReport({out}, out / run_folder::kReport);
  }
  if (!options.quiet) {
    PrintImport(result, out);
  }
  return result.interrupted ? kInterrupted : kOk;
}

}  // namespace

void AddImport(const Command& command) {
  const auto options = std::make_shared<ImportOptions>();
  command.AddPositional("log", options->log, "Log of a real vehicle, a CSV file")
      .Required()
      .TypeName("LOG");
  command
      .AddOption("--map", options->map,
                 "How to read it: names of columns, units, frames and filters")
      .Required()
      .TypeName("MAP");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<log>)").TypeName("DIR");
  command
      .AddOption("--vehicle", options->vehicle,
                 "The vehicle, a model by name or the path of an MJCF file: where its center of "
                 "gravity is, and how it looks")
      .ShowDefault()
      .TypeName("MODEL");
  AddAllowAssets(command, options->asset_folders);
  command.AddFlag("--align", options->align,
                  "Shift the measured speed, yaw rate and accelerations by their delay behind the "
                  "motion of the pose");
  command.AddFlag("--report", options->report, "Also write report.html in the run folder");
  command.AddFlag("--mcap", options->mcap, "Also write run.mcap (Foxglove) in the run folder");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("A log as a run whose plant is recorded",
                     "trackbed import drive.csv --map map.yaml --vehicle bmw320i --report");
  command.AddExample("Replay it on other plants",
                     "trackbed run out/drive/scenario.resolved.yaml --plants "
                     "recorded,kinematic,mujoco -o out/replay");
  command.OnRun([options] { return Import(*options); });
}

}  // namespace trackbed::cli

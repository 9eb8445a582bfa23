#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/globe_file.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/log_listing.h"
#include "trackbed/report/report.h"
#include "trackbed/scenario/log_map_text.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/record_scenario.h"

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
  bool list = false;
};

/// Prints the topics and columns of a log, and a proposed map from log columns to Trackbed's
/// quantities.
int List(const std::string& log) {
  const LogListing listing = ListLog(log);
  for (const LogTopic& topic : listing.topics) {
    Print("# {}{}{}, {} {}{}\n", topic.name, topic.name.empty() ? "" : ": ", topic.type, topic.rows,
          topic.rows == 1 ? "row" : "rows",
          topic.problem.empty() ? "" : ", not readable: " + topic.problem);
    for (const std::string& column : topic.columns) {
      Print("#   {}\n", column);
    }
  }
  for (const std::string& note : listing.notes) {
    Print("# {}\n", note);
  }
  if (listing.map) {
    Print("# A map that reads this log; check the units and frames.\n");
    std::istringstream lines(LogMapText(*listing.map));
    for (std::string line; std::getline(lines, line);) {
      Print("{}\n", line);
    }
  } else {
    Print("# No map: {}\n", listing.problem);
  }
  return kOk;
}

/// Returns the map from log columns to quantities: the user's, or else the fixed map for GPX, KML
/// or GeoJSON files.
LogMap MapOf(const ImportOptions& options) {
  if (!options.map.empty()) {
    return ReadLogMap(options.map);
  }
  if (!IsGlobeFile(options.log)) {
    throw InputError(Problem{
        .key = "--map",
        .message = fmt::format("missing; `trackbed import {} --list` prints a map to begin with",
                               options.log)});
  }
  const LogListing listing = ListLog(options.log);
  if (!listing.map) {
    throw InputError(Problem{.file = options.log, .message = listing.problem});
  }
  return *listing.map;
}

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
  if (options.list) {
    return List(options.log);
  }
  LogMap map = MapOf(options);
  map.align = map.align || options.align;
  auto drive = std::make_shared<const RecordedDrive>(ImportLog(options.log, map));
  Scenario scenario = RecordScenario(std::move(drive), options.vehicle);
  scenario.asset_folders = Paths(options.asset_folders);
  CheckScenario(scenario);
  const fs::path out = OutputFolderOf(options.out, scenario.name);
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
  command
      .AddPositional(
          "log", options->log,
          "Log of a real vehicle: CSV, VBO, GPX, KML, GeoJSON, or a bag of ROS 2 (.mcap, "
          ".db3, a folder)")
      .Required()
      .TypeName("LOG");
  command
      .AddOption("--map", options->map,
                 "How to read it: names of columns, units, frames and filters; required for CSV "
                 "and bags")
      .TypeName("MAP");
  command.AddFlag("--list", options->list,
                  "Print the topics and columns of the log, and a map that reads it");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<log>)").TypeName("DIR");
  command
      .AddOption("--vehicle", options->vehicle,
                 "The vehicle, a model by name or the path of an MJCF file: where its center of "
                 "gravity is, and how it looks")
      .ShowDefault()
      .TypeName("MODEL");
  AddAllowAssets(command, options->asset_folders);
  command.AddFlag("--align", options->align,
                  "Shift the measured signals by their delay behind the motion of the pose");
  command.AddFlag("--report", options->report, "Also write report.html in the run folder");
  command.AddFlag("--mcap", options->mcap, "Also write run.mcap (Foxglove) in the run folder");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("A log as a run whose plant is recorded",
                     "trackbed import drive.csv --map map.yaml --vehicle bmw320i --report");
  command.AddExample("What is in a bag of ROS 2, and a map to begin with",
                     "trackbed import drive.mcap --list > map.yaml");
  command.AddExample("Replay it on other plants",
                     "trackbed run out/drive/scenario.resolved.yaml --plants "
                     "recorded,kinematic,mujoco -o out/replay");
  command.OnRun([options] { return Import(*options); });
}

}  // namespace trackbed::cli

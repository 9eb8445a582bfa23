#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "src/cli/film_of_run.h"
#include "src/cli/output_file.h"
#include "src/cli/run_summary.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/drive/drive.h"
#include "trackbed/path_files/path_map.h"
#include "trackbed/planning/path_file/path_check.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/path_file/steerable_fit.h"
#include "trackbed/report/path_check.h"
#include "trackbed/report/report.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct CheckPathOptions {
  std::string file;
  std::string vehicle = VehicleSpec{}.model;
  double speed = 0.0;
  std::optional<std::string> fit;
  std::optional<double> max_deviation;
  bool closed = false;
  std::string report;
  bool json = false;
  bool drive = false;
  bool video = false;
  std::string gl = FilmOptions{}.gl;
  std::string out;
  ScenarioOptions scenario;
};

/// Converts the name of a path file to a valid scenario name.
std::string NameOf(const fs::path& file) {
  std::string name = file.stem().string();
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return c > 127 || (std::isalnum(c) == 0 && c != '_' && c != '-'); },
      '_');
  return name.empty() ? "path" : name;
}

/// Returns the text of a scenario in which a car follows the path of a path file. The generated
/// scenario has no expectations. The scenario is written as JSON, which is valid YAML.
std::string ScenarioText(const CheckPathOptions& options) {
  const fs::path file = options.file;
  nlohmann::ordered_json plan{
      {"method", "path_file"}, {"file", file.filename().string()}, {"infeasible", "allow"}};
  if (options.fit) {
    plan["fit"] = *options.fit;
  }
  if (options.max_deviation) {
    plan["max_deviation"] = *options.max_deviation;
  }
  if (options.closed) {
    plan["closed"] = true;
  }
  const nlohmann::ordered_json scenario{{"schema", 1},
                                        {"name", NameOf(file)},
                                        {"vehicle", {{"model", options.vehicle}}},
                                        {"mission", {{"speed", options.speed}}},
                                        {"plan", plan}};
  return scenario.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

PathCheckOptions CheckOptions(const Scenario& scenario, const CarModel& car) {
  const VehicleParams& vehicle = car.unladen();
  PathCheckOptions options{.speed = scenario.mission.speed, .friction = scenario.world.friction};
  if (vehicle.kind == VehicleKind::kSteered) {
    options.rollover_acceleration = RollOverAcceleration(
        std::min(vehicle.track_front, vehicle.track_rear), car.parts().cg_height);
  }
  return options;
}

void PrintCheck(const Scenario& scenario, const FittedPath& fitted, const PathCheck& check,
                const std::string& all_notes) {
  constexpr std::size_t kMaxFaults = 10;
  Print("{}: {} at {:.3g} m/s with {}\n", scenario.name,
        check.drivable() ? Colorize(Tone::kGood, "drivable") : Colorize(Tone::kBad, "not drivable"),
        scenario.mission.speed, scenario.vehicle.model);
  if (fitted.reversals.empty()) {
    Print("  {:.4g} m, {}\n", fitted.path.length(), Describe(fitted));
    if (check.max_speed > 0.0 && std::isfinite(check.max_speed)) {
      Print("  up to {:.3g} m/s, limited by {} at s = {:.4g} m\n", check.max_speed,
            ToString(check.max_speed_limit), check.max_speed_station);
    } else if (check.max_speed == 0.0) {
      Print("  at no speed: {} at s = {:.4g} m\n", ToString(check.max_speed_limit),
            check.max_speed_station);
    }
  }
  if (!fitted.reversals.empty()) {
    Print("  the path turns back on itself{}\n", ReversalRemedy(fitted, "use --max-deviation"));
  }
  std::istringstream notes(all_notes);
  for (std::string note; std::getline(notes, note);) {
    Print("  {}\n", note);
  }
  for (std::size_t i = 0; i < std::min(kMaxFaults, check.faults.size()); ++i) {
    Print("  {}\n", ToString(check.faults[i]));
  }
  if (check.faults.size() > kMaxFaults) {
    Print("  and {} more\n", check.faults.size() - kMaxFaults);
  }
}

int Drive(const CheckPathOptions& options, const Scenario& scenario) {
  const fs::path out = OutputFolderOf(options.out, scenario.name);
  const auto [folder, result, finishing] = DriveScenario({scenario, out}, options.scenario.quiet);
  WriteRunFolder(result, folder);
  if (options.scenario.quiet) {
    PrintFailures(result);
  } else if (!options.json) {
    PrintSummary(result, out);
  }
  if (options.video && !result.interrupted && result.plan.ok()) {
    FilmRun(out, out / run_folder::kVideo, FilmOptionsOf(scenario.render, options.gl),
            options.scenario.quiet);
  }
  return ExitCodeOf(result);
}

int CheckPathFile(const CheckPathOptions& options) {
  const fs::path file = options.file;
  // Open the file here, so that the error message for an unreadable file names the file and not a
  // key of the generated scenario.
  static_cast<void>(OpenInput(file));
  if (!options.report.empty()) {
    PrepareOutputFile("--report", options.report, {file}, HasInHead(std::string(kPageMark)));
  }
  const Scenario scenario =
      options.scenario.Parse(ScenarioText(options), "check-path", file.parent_path());
  const auto* plan = scenario.plan ? scenario.plan->global.GetIf<PathFileOptions>() : nullptr;
  if (plan == nullptr) {
    throw InputError(Problem{.file = "--set", .key = "plan", .message = "must stay path_file"});
  }
  const CarModel car = LoadCar(scenario);
  const PathCheckOptions check_options = CheckOptions(scenario, car);
  // Check the path that a run would follow: the plan's path, refitted within the steering limits if
  // possible.
  const std::optional<SteerableFit> steerable = FitWithinSteering(*plan->path, car.unladen());
  const FittedPath& fitted = steerable ? steerable->path : *plan->path;
  const PathCheck check = CheckPath(fitted, car.unladen(), check_options);
  std::string notes = plan->notes.value_or("");
  if (steerable) {
    notes += (notes.empty() ? "" : "\n") + steerable->note;
  }
  const PathCheckTitle title{scenario.name, scenario.vehicle.model, notes};
  if (options.json) {
    const nlohmann::ordered_json json = PathCheckJson(title, fitted, check, check_options);
    Print("{}\n",
          Lines{json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)});
  } else if (!options.scenario.quiet) {
    PrintCheck(scenario, fitted, check, notes);
  }
  if (!options.report.empty()) {
    WriteFileAtomically(options.report,
                        ReportPage(PathCheckReport(title, fitted, check, check_options)));
  }
  const int verdict = check.drivable() ? kOk : kFailedExpectations;
  return options.drive ? std::max(verdict, Drive(options, scenario)) : verdict;
}

}  // namespace

void AddCheckPath(const Command& command) {
  const auto options = std::make_shared<CheckPathOptions>();
  command.AddPositional("file", options->file, "The path: " + PathFormatList())
      .Required()
      .TypeName("FILE");
  command.AddOption("--speed", options->speed, "Speed to check at [m/s]")
      .Required()
      .Range(0.1, 100.0)
      .TypeName("SPEED");
  command.AddOption("--vehicle", options->vehicle, "The vehicle, a model by name")
      .ShowDefault()
      .TypeName("MODEL");
  command
      .AddOption("--fit", options->fit,
                 "spline, within --max-deviation of the points, or polyline (default: spline)")
      .TypeName("FIT");
  command
      .AddOption("--max-deviation", options->max_deviation,
                 "Largest distance of the points from the spline [m] (default: 0.05)")
      .TypeName("DISTANCE");
  command.AddFlag("--closed", options->closed, "The path leads back to its first point");
  command.AddOption("--report", options->report, "Also write a page with a map and charts")
      .TypeName("FILE");
  command.AddFlag("--json", options->json, "Print the result as JSON");
  command.AddFlag("--drive", options->drive,
                  "Also drive it, on both plants, and write a run folder");
  command.AddFlag("--video", options->video,
                  "With --drive: also render video.mp4 in the run folder");
  AddGlOption(command, options->gl);
  command.AddOption("-o,--out", options->out, "With --drive: run folder (default: out/<file>)")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.AddExample("Whether a Prius can drive a path at 8 m/s",
                     "trackbed check-path path.csv --vehicle prius --speed 8 --report path.html");
  command.AddExample("Columns of other names",
                     "trackbed check-path path.csv --speed 8 --set plan.columns.x=east "
                     "plan.columns.y=north");
  command.OnRun([options] {
    if ((options->video || !options->out.empty()) && !options->drive) {
      throw InputError(Problem{.message = "--video and --out need --drive"});
    }
    if (options->video) {
      CheckGl(options->gl);
    }
    return CheckPathFile(*options);
  });
}

}  // namespace trackbed::cli

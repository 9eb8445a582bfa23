#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/fmu/export.h"

namespace trackbed::cli {
namespace {

struct FmuVerbOptions {
  std::string file;
  std::string out;
  std::string plant;
  std::string fmi = "3";
  ScenarioOptions scenario;
};

/// Returns the plant (car model) to export: the plant of the command line option, or else the last
/// plant of the scenario. The last plant of a scenario is by convention the most detailed plant.
std::string PlantOf(const FmuVerbOptions& options, const Scenario& scenario) {
  return options.plant.empty() ? scenario.drive.plants.back() : options.plant;
}

/// Reads a version of FMI, such as 3 or 3.0.
FmiVersion VersionOf(const std::string& text) {
  if (text == "2" || text == "2.0") {
    return FmiVersion::k2;
  }
  if (text == "3" || text == "3.0") {
    return FmiVersion::k3;
  }
  throw InputError(
      Problem{.key = "--fmi", .message = fmt::format("unknown version '{}'; allowed: 2, 3", text)});
}

int RunFmuVerb(FmuVerbOptions& options) {
  if (!options.plant.empty()) {
    options.scenario.plants = {options.plant};
  }
  const FmiVersion version = VersionOf(options.fmi);
  const Scenario scenario = options.scenario.Read(options.file);
  const std::string plant = PlantOf(options, scenario);
  PrepareOutputFile("--out", options.out, {options.file}, EndsWith(kFmuMark));
  ExportFmu(scenario, plant, options.out, version);
  if (!options.scenario.quiet) {
    Print("{}: the plant {} as a co-simulation FMU (FMI {}.0), in {}\n", scenario.name, plant,
          static_cast<int>(version), options.out);
  }
  return kOk;
}

}  // namespace

void AddFmu(const Command& command) {
  const auto options = std::make_shared<FmuVerbOptions>();
  command.AddPositional("file", options->file, "Scenario file").Required().TypeName("SCENARIO");
  command.AddOption("-o,--out", options->out, "FMU to write").Required().TypeName("FILE");
  command
      .AddOption("--plant", options->plant,
                 "Plant that the FMU simulates (default: the scenario's last plant)")
      .TypeName("PLANT");
  command.AddOption("--fmi", options->fmi, "Version of FMI: 2 or 3").TypeName("2|3").ShowDefault();
  options->scenario.AddKeysTo(command);
  command.AddExample("The car of a shipped scenario, for FMI 3 tools",
                     "trackbed fmu three_turns -o car.fmu");
  command.OnRun([options] { return RunFmuVerb(*options); });
}

}  // namespace trackbed::cli

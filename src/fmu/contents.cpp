#include "src/fmu/contents.h"

#include <fmt/format.h>

#include <system_error>

#include "src/fmu/shared_library.h"
#include "src/fmu/variables.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/sim/scene.h"

namespace trackbed::fmu {

namespace fs = std::filesystem;

namespace {

/// Adds the files of the car to the FMU's resources. The files of a car model shipped with Trackbed
/// are copied unchanged, because CompileScene compiles such files without a separate process. Any
/// other car model is composed to one MJCF file, as in a run folder.
void AddVehicle(const Scenario& scenario, Resources& resources) {
  const fs::path model = FindModel(scenario.vehicle.model, scenario.folder);
  if (HasOwnVehicle(scenario.vehicle)) {
    const Scene scene = ComposeScene(model, MakeSceneOptions(scenario));
    for (const SceneAsset& asset : scene.assets) {
      resources.emplace(asset.name, asset.content);
    }
    resources.emplace(kVehicleXml, scene.xml);
    return;
  }
  resources.emplace(kVehicleXml, ReadFile(model));
  for (const auto& entry : fs::directory_iterator(model.parent_path())) {
    if (entry.is_regular_file() && entry.path() != model) {
      resources.emplace(entry.path().filename().string(), ReadFile(entry.path()));
    }
  }
}

}  // namespace

Scenario ScenarioOfFmu(const Scenario& scenario, const std::string& plant) {
  Scenario own = scenario;
  own.drive.plants = {plant};
  own.expect = {};
  own.render = {};
  return own;
}

Resources MakeResources(const Scenario& scenario) {
  Resources resources;
  for (const InputFile& file : InputFiles(scenario)) {
    resources.emplace(file.name, file.content);
  }
  AddVehicle(scenario, resources);
  Scenario with_own_files = scenario;
  // Use a model name with a slash, because PortableYaml replaces paths by the name of the copied
  // file.
  with_own_files.vehicle.model = fs::path("./") / kVehicleXml;
  resources.emplace(kScenarioYaml, PortableYaml(with_own_files));
  return resources;
}

fs::path FindLibrary() {
  const fs::path own = OwnFile().parent_path();
  // In the build tree, the FMU library is beside the program, one folder above the tests, and two
  // folders above the Python module.
  std::error_code ignored;
  for (const char* place : {"", TRACKBED_FMU_FROM_PROGRAM, "trackbed", "..", "../.."}) {
    const fs::path file = (own / place / "trackbed_fmu.so").lexically_normal();
    if (fs::is_regular_file(file, ignored)) {
      return file;
    }
  }
  throw RunError(
      fmt::format("the library of FMUs, trackbed_fmu.so, is missing: neither {} nor its "
                  "installation has it; export with the program trackbed of a build or "
                  "of an installed package",
                  own.string()));
}

}  // namespace trackbed::fmu

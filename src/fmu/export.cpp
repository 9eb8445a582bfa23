#include "trackbed/fmu/export.h"

#include <fmt/format.h>

#include <map>
#include <utility>
#include <vector>

#include "src/fmu/carried_libraries.h"
#include "src/fmu/contents.h"
#include "src/fmu/fmi3_interface.h"
#include "src/fmu/licenses.h"
#include "src/fmu/model_description.h"
#include "src/fmu/resources.h"
#include "src/fmu/shared_library.h"
#include "src/fmu/variables.h"
#include "src/fmu/zip_archive.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/plant.h"

// Makes the files of an FMU in memory: the resources (scenario, car and input files) and the
// description of the variables. The exporter adds the shared library trackbed_fmu.so, the libraries
// that it needs, and the licenses of all added libraries. Before the FMU is written, the shared
// library is tested with the resources.
namespace trackbed {

namespace fs = std::filesystem;

namespace {

using fmu::Resources;
using fmu::SharedLibrary;

/// Returns the folder of the library in an FMU.
std::string BinaryFolder(FmiVersion version) {
#if defined(__x86_64__)
  return version == FmiVersion::k3 ? "binaries/x86_64-linux" : "binaries/linux64";
#elif defined(__aarch64__)
  if (version == FmiVersion::k2) {
    throw InputError(Problem{.key = "--fmi", .message = "FMI 2 has no name for 64-bit ARM; use 3"});
  }
  return "binaries/aarch64-linux";
#else
#error "FMI has no name for this architecture that Trackbed knows"
#endif
}

/// Instantiates and initializes the FMU once, in a temporary folder beside `file`.
void TryResources(const Resources& resources, const std::string& token,
                  const SharedLibrary& library, const fs::path& file) {
  const TemporaryFolder folder(file);
  for (const auto& [name, content] : resources) {
    WriteNewFile(folder.path() / name, content, file);
  }
  std::string messages;
  const auto log = [](fmi3InstanceEnvironment environment, fmi3Status status, fmi3String,
                      fmi3String message) {
    if (status == fmi3Error) {
      std::string& text = *static_cast<std::string*>(environment);
      text += (text.empty() ? "" : "\n") + std::string(message);
    }
  };
  const fmi3Instance instance = library.Find<fmi3InstantiateCoSimulationTYPE>(
      "fmi3InstantiateCoSimulation")("trackbed", token.c_str(), folder.path().c_str(), false, false,
                                     false, false, nullptr, 0, &messages, log, nullptr);
  if (instance != nullptr) {
    if (library.Find<fmi3EnterInitializationModeTYPE>("fmi3EnterInitializationMode")(
            instance, false, 0.0, 0.0, false, 0.0) == fmi3OK) {
      library.Find<fmi3ExitInitializationModeTYPE>("fmi3ExitInitializationMode")(instance);
    }
    library.Find<fmi3FreeInstanceTYPE>("fmi3FreeInstance")(instance);
  }
  if (!messages.empty() || instance == nullptr) {
    // Remove the path of the temporary folder from the messages, so that they name the files by
    // their paths in the FMU.
    const std::string own = folder.path().string() + "/";
    for (std::size_t at = messages.find(own); at != std::string::npos; at = messages.find(own)) {
      messages.erase(at, own.size());
    }
    throw InputError(Problem{.message = "the FMU would not start: " + messages});
  }
}

std::vector<fmu::ZipEntry> MakeEntries(const Resources& resources, const std::string& description,
                                       const fs::path& library, FmiVersion version) {
  const std::string folder = BinaryFolder(version);
  std::vector<fmu::ZipEntry> entries{{"modelDescription.xml", description}};
  for (const auto& [name, content] : resources) {
    entries.push_back({"resources/" + name, content});
  }
  entries.push_back({fmt::format("{}/{}.so", folder, fmu::kModelIdentifier), ReadFile(library)});
  const std::map<std::string, fs::path> carried = fmu::CarriedLibraries(library);
  for (const auto& [name, file] : carried) {
    entries.push_back({folder + "/" + name, ReadFile(file)});
  }
  for (fmu::ZipEntry& entry : fmu::LicenseEntries(library, carried)) {
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace

void ExportFmu(const Scenario& scenario, const std::string& plant, const fs::path& file,
               FmiVersion version) {
  if (plant == kRecordedPlant) {
    throw InputError(Problem{.key = "--plant",
                             .message = fmt::format("the plant {} is a recorded drive, which does "
                                                    "not react to commands; must be another plant",
                                                    plant)});
  }
  const fs::path library_file = fmu::FindLibrary();
  const Scenario own = fmu::ScenarioOfFmu(scenario, plant);
  const Resources resources = fmu::MakeResources(own);
  const std::string token = fmu::TokenOf(resources);
  PrepareToWrite(file);
  {
    const SharedLibrary library(library_file);
    TryResources(resources, token, library, file);
  }
  const std::string description = fmu::ModelDescription(
      {.name = own.name, .token = token, .control_period = own.drive.control_period},
      fmu::Variables(resources.at(fmu::kScenarioYaml), own), version);
  WriteFileAtomically(
      file, fmu::MakeZip(MakeEntries(resources, description, library_file, version), kFmuMark));
}

}  // namespace trackbed

#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "trackbed/scenario/scenario.h"

namespace trackbed::fmu {

/// The files in the folder `resources` of an FMU: contents by name.
using Resources = std::map<std::string, std::string>;

/// Returns the scenario that an FMU contains: `scenario` for one plant, without expectations and
/// video.
Scenario ScenarioOfFmu(const Scenario& scenario, const std::string& plant);

/// Returns the resources of an FMU: the scenario, the car and all files that the scenario names.
/// MakeResources throws InputError in the same cases as LoadCar.
Resources MakeResources(const Scenario& scenario);

/// Returns the shared library of FMUs, trackbed_fmu.so, of this build or installation. Throws
/// RunError if this file does not exist.
std::filesystem::path FindLibrary();

}  // namespace trackbed::fmu

#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the scenario with each file name replaced by the name of the file's copy in a run
/// folder. The name is kVehicleXml for the vehicle, and the one that InputFiles defines for every
/// other file.
Scenario WithResolvedFiles(const Scenario& scenario);

}  // namespace trackbed

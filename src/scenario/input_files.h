#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the scenario with each file name replaced by the name of the file's copy in a run
/// folder: kVehicleXml for the vehicle, and the names that InputFiles defines for all other files.
Scenario WithResolvedFiles(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the scenario with all file names replaced by the names in a run folder: the names of
/// InputFiles, and kVehicleXml for the vehicle.
Scenario WithResolvedFiles(const Scenario& scenario);

}  // namespace trackbed

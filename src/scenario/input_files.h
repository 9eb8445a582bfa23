#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// The scenario with the file names of a run folder: those of InputFiles, and kVehicleXml.
Scenario WithResolvedFiles(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the scenario with each file name replaced by the name of the file's copy in a run
/// folder. The copy of the vehicle file is named kVehicleXml. The function InputFiles defines the
/// names of the copies of all other input files.
Scenario WithResolvedFiles(const Scenario& scenario);

}  // namespace trackbed

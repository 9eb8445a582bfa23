#pragma once

#include <string>
#include <vector>

#include "trackbed/options/method_rules.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the input files of a scenario in the form in which the run folder stores them. The files
/// are the recorded drive, track, map and road network, and the files of the controller and
/// planner. The vehicle model is not included.
std::vector<InputFile> InputFiles(const Scenario& scenario);

/// All names that InputFiles may return, for all registered controllers and planners.
std::vector<std::string> InputFileNames();

}  // namespace trackbed

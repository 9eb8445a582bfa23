#pragma once

#include <string>
#include <vector>

#include "trackbed/options/method_rules.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the input files of a scenario, with the names and contents that are stored in the run
/// folder. The input files are the recorded drive, track, map and road network, and the files that
/// the controller and planner read. The file of the vehicle model is not included in the list.
std::vector<InputFile> InputFiles(const Scenario& scenario);

/// Returns all file names that InputFiles may return, for all registered controllers and planners.
std::vector<std::string> InputFileNames();

}  // namespace trackbed

#pragma once

#include <string>
#include <vector>

#include "trackbed/options/method_rules.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// The files of a scenario as a run folder keeps them beside the resolved scenario: its recorded
/// drive, track, map and road network, and the files of its controller and planner. Not the
/// vehicle's model.
std::vector<InputFile> InputFiles(const Scenario& scenario);

/// Every name that InputFiles may return, for all registered controllers and planners.
std::vector<std::string> InputFileNames();

}  // namespace trackbed

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the problem of a camera's name; "" for the name of a camera.
std::string CameraProblem(const std::string& camera);

/// Returns the problems of single values of a scenario, each paired with its dotted key: numbers
/// that are not finite or out of range, unknown names, and names that are listed twice. The ranges
/// and names are those of scenario files, so a scenario that ReadScenario has read has no problems.
std::vector<std::pair<std::string, std::string>> ValueProblems(const Scenario& scenario);

}  // namespace trackbed

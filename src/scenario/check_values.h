#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns an error message if `camera` is not the name of a camera, else "".
std::string CameraProblem(const std::string& camera);

/// Returns an error message if the list of numbers is not a valid local origin, else "".
std::string OriginProblem(const std::vector<double>& origin);

/// Returns the problems of single values of a scenario, each paired with its dotted key.
/// ValueProblems finds numbers that are not finite or out of range, unknown or missing names, names
/// that are listed twice, and files that have not been read. ValueProblems permits the same ranges
/// and names as scenario files, so a scenario that ReadScenario has read has no problems.
std::vector<std::pair<std::string, std::string>> ValueProblems(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the problems of the requirements, as pairs of key and message. RequirementProblems
/// expects a scenario that has no other problems.
std::vector<std::pair<std::string, std::string>> RequirementProblems(const Scenario& scenario);

}  // namespace trackbed

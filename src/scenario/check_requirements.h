#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// What is wrong with the requirements of a scenario that has no other problems, each with the key.
std::vector<std::pair<std::string, std::string>> RequirementProblems(const Scenario& scenario);

}  // namespace trackbed

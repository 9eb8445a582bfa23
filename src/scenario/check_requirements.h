#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Problems of the requirements of a scenario that has no other problems: pairs of key and message.
std::vector<std::pair<std::string, std::string>> RequirementProblems(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the problems of the requirements, each as a pair of the key and the error message. The
/// scenario must have no problems outside the requirements.
std::vector<std::pair<std::string, std::string>> RequirementProblems(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the problems that concern more than one key, each paired with the key that the user
/// should change. The function `could_read` tells whether a dotted key was read. Checks of keys
/// that were not read are skipped, because these checks would only report follow-up errors.
std::vector<std::pair<std::string, std::string>> CrossProblems(
    const Scenario& scenario, const std::function<bool(const std::string& key)>& could_read);

/// Returns whether the scenario runs the plant `plant`.
bool Drives(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed

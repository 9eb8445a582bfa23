#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Problems that concern more than one key, each with the key to change. Checks of keys that could
/// not be read (`could_read` takes a dotted key) are skipped, because they would only cause
/// follow-up errors.
std::vector<std::pair<std::string, std::string>> CrossProblems(
    const Scenario& scenario, const std::function<bool(const std::string& key)>& could_read);

/// Whether the scenario runs the plant `plant`.
bool Drives(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed

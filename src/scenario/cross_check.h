#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the problems of a scenario that concern several of its keys, each paired with the key
/// that the user should change. The function `could_read` returns whether the value of a dotted key
/// was read. CrossProblems skips a check if one of its keys was not read, because that check would
/// only report a follow-up error of the unread key.
std::vector<std::pair<std::string, std::string>> CrossProblems(
    const Scenario& scenario, const std::function<bool(const std::string& key)>& could_read);

/// Returns whether the scenario runs the plant `plant`.
bool Drives(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed

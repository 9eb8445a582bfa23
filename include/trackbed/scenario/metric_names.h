#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Finds expectations on metrics that are not among the `possible` metrics of a run. For each
/// unknown metric, returns the dotted key and an error message that suggests the most similar
/// metric.
std::vector<std::pair<std::string, std::string>> UnknownMetrics(
    const Expectations& expect, const std::vector<std::string>& possible);

}  // namespace trackbed

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Whether a setting of the key `later` leaves nothing of what `earlier` was set to.
bool Replaces(const std::string& later, const std::string& earlier);

/// What is set in a run at a point of the grid, in the order in which it is.
std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected);

/// One setting or more of every key that is not the same in all runs.
std::vector<Setting> Varied(const Study& study);

}  // namespace trackbed

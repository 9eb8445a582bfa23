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

/// The number that a value of YAML is, if it is one.
std::optional<double> NumberOf(const std::string& value);

/// Adds what the formulas of the study say at a point that sets these. InputError placed at a
/// formula that has no finite value there.
void AddDerived(const Study& study, std::vector<Setting>& settings);

/// InputError placed at a formula that is none, or that uses what the study does not set.
void CheckFormulas(const Study& study);

/// One setting or more of every key that is not the same in all runs.
std::vector<Setting> Varied(const Study& study);

}  // namespace trackbed

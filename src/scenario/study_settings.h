#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Returns whether a setting of the key `later` overwrites an earlier setting of the key `earlier`
/// completely.
bool Replaces(const std::string& later, const std::string& earlier);

/// Returns all settings of a run at a grid point, in the order in which the settings are applied.
std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected);

/// Parses a YAML value as a number; returns none if the value is not a number.
std::optional<double> NumberOf(const std::string& value);

/// Evaluates the study's formulas at a point with these settings and appends the results to the
/// settings. If a result is not finite, AddDerived throws InputError with the position of the
/// formula.
void AddDerived(const Study& study, std::vector<Setting>& settings);

/// Checks the formulas of a study. If a formula is invalid or uses a key that the study does not
/// set, CheckFormulas throws InputError with the position of the formula.
void CheckFormulas(const Study& study);

/// Returns settings of all keys whose values differ between runs, with at least one setting for
/// each of these keys.
std::vector<Setting> Varied(const Study& study);

}  // namespace trackbed

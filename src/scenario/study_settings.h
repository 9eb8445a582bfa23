#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Whether setting the key `later` discards everything set by `earlier`.
bool Replaces(const std::string& later, const std::string& earlier);

/// All settings of a run at a grid point, in the order in which they are applied.
std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected);

/// Parses a YAML value as a number; none if it is not a number.
std::optional<double> NumberOf(const std::string& value);

/// Appends the values of the study's formulas at a point with these settings. AddDerived throws
/// InputError, placed at the formula, if a value is not finite.
void AddDerived(const Study& study, std::vector<Setting>& settings);

/// Throws InputError, placed at the formula, if a formula is invalid or uses a key that the study
/// does not set.
void CheckFormulas(const Study& study);

/// Settings of the keys that differ between runs, at least one per key.
std::vector<Setting> Varied(const Study& study);

}  // namespace trackbed

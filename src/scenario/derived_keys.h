#pragma once

#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Evaluates the study's formulas for derived keys at a study point and appends the results to the
/// settings of the point. If the result of a formula is not finite, AddDerived throws InputError
/// with the position of the formula.
void AddDerived(const Study& study, std::vector<Setting>& settings);

/// Checks the formulas of a study. If a formula is invalid or uses a key that the study does not
/// set, CheckFormulas throws InputError with the position of the formula.
void CheckFormulas(const Study& study);

}  // namespace trackbed

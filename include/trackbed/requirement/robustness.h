#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/requirement/formula.h"

/// Evaluates formulas on the log of a run.
namespace trackbed {

/// The result of evaluating a formula at the first sample of a log.
struct FormulaResult {
  /// Robustness of the formula, in the unit of the comparison that determines the robustness. The
  /// robustness is +-infinity if no sample determines the robustness, because all relevant time
  /// windows of the formula begin after the end of the log.
  double robustness = 0.0;
  /// Whether the formula is satisfied, that is, whether the robustness is > 0. If the robustness is
  /// 0, the comparison operator decides: if x = y, `x <= y` is satisfied, but `x < y` is not.
  bool satisfied = false;
  /// Row of the log with the sample that determines the robustness; the earliest row if several
  /// samples determine it.
  std::optional<std::size_t> row;
};

/// Evaluates a formula at the first sample of a log. The log must have a column for each signal of
/// the formula, and a column `t_s` with increasing times [s]. Throws InputError, naming signal and
/// time, if a signal is missing or not finite, or if a comparison yields no finite number (division
/// by zero). Throws InputError if the times do not increase or the log has no rows. The evaluation
/// needs O(steps x rows) time, for windows of any length (Lemire 2006), and O(depth x rows) memory.
FormulaResult Evaluate(const Formula& formula, const Table& log);

/// Returns the robustness of a formula at the first sample of the log: > 0 if the formula is
/// satisfied, < 0 if the formula is violated. Throws InputError in the same cases as Evaluate.
double Robustness(const Formula& formula, const Table& log);

/// Returns the robustness of a formula at each sample, computed as if the log began with this
/// sample. Throws InputError in the same cases as Evaluate.
std::vector<double> RobustnessOverTime(const Formula& formula, const Table& log);

}  // namespace trackbed

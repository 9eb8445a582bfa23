#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/table.h"

/// Requirements on logged signals in signal temporal logic, and their robustness on a log.
///
///     const Formula lane = Formula::Parse("always[0, T] abs(cross_track_m) < 0.5", log.columns());
///     const double margin = Robustness(lane, log);  // > 0: met with this margin
///
/// Grammar, from the weakest to the strongest operator (docs/how-to/requirements.md):
///
///     phi implies psi                      right associative
///     phi or psi,  phi and psi
///     phi until[a, b] psi                  not associative
///     not phi,  always[a, b] phi,  eventually[a, b] phi
///     x < y,  x <= y,  x > y,  x >= y
///     x + y,  x - y,  x * y,  x / y,  -x
///     number, signal, abs(x), min(x, y, …), max(x, y, …), ( )
///
/// Bounds a and b are seconds from the moment at which the formula is evaluated, 0 <= a <= b, or
/// `T`, the duration of the log, or `T - c`, at least 0. The default window is [0, T].
///
/// Semantics (Donzé and Maler 2010; Fainekos and Pappas 2009), over the samples i of a log at times
/// t_i:
///
///     x < y, x <= y         y - x;  x > y, x >= y: x - y
///     not phi               -phi
///     phi and psi           min(phi, psi);  or: max;  implies: max(-phi, psi)
///     always[a, b] phi      minimum of phi over the samples with t_i + a <= t_j <= t_i + b
///     eventually[a, b] phi  maximum of phi over these samples
///     phi until[a, b] psi   maximum over these j of min(psi_j, phi_i, …, phi_{j-1})
///
/// Samples are not interpolated, and bounds hold to 1 ns. A window that extends beyond the end of
/// the log is clipped to it. Without samples in the window, `always` is +infinity, `eventually` and
/// `until` are -infinity, as in RTAMT (Nickovic and Yamaguchi 2020).
namespace trackbed {

/// A bound of a window: a time, or a time before the end of the log.
struct WindowBound {
  double seconds = 0.0;   ///< [s]; non-negative
  bool from_end = false;  ///< the bound is T - seconds
};

/// The operations of a formula.
enum class FormulaOperation {
  kNumber,
  kSignal,
  kNegate,
  kAbs,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kMin,
  kMax,
  kLess,
  kLessOrEqual,
  kGreater,
  kGreaterOrEqual,
  kNot,
  kAnd,
  kOr,
  kImplies,
  kAlways,
  kEventually,
  kUntil,
};

/// One step of a formula in postfix order: it pops its one or two operands from a stack and pushes
/// its result.
struct FormulaStep {
  FormulaOperation operation = FormulaOperation::kNumber;
  double number = 0.0;     ///< of kNumber
  std::size_t signal = 0;  ///< of kSignal: index into Formula::signals
  WindowBound from{};      ///< of kAlways, kEventually and kUntil
  WindowBound to{};
  std::size_t begin = 0;  ///< the text of the step and its operands, [begin, end)
  std::size_t end = 0;
};

/// A parsed formula.
class Formula {
 public:
  static constexpr std::size_t kMaxLength = 4096;  ///< of the text [bytes]
  static constexpr std::size_t kMaxDepth = 50;     ///< nesting of parentheses and operators

  /// InputError with the column of the text (from 1), the text found and the alternatives: for a
  /// syntax error; for a signal that is not among `signals` (with the nearest spelling); for a
  /// number instead of a condition, or the reverse; for bounds out of order or above 1e6 s; for a
  /// formula without signals; and for exceeding kMaxLength or kMaxDepth. Cost O(length).
  static Formula Parse(std::string_view text, const std::vector<std::string>& signals);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// The signals used, in order of first use.
  [[nodiscard]] const std::vector<std::string>& signals() const { return signals_; }
  /// The time after a sample within which the log can affect the robustness at the sample [s];
  /// infinity if a bound is relative to the end of the log, or missing.
  [[nodiscard]] double horizon_s() const;
  [[nodiscard]] const std::vector<FormulaStep>& steps() const { return steps_; }

 private:
  std::string text_;
  std::vector<std::string> signals_;
  std::vector<FormulaStep> steps_;
};

/// The value of a formula at the first sample of a log.
struct FormulaResult {
  /// In the unit of the decisive comparison; +-infinity if no sample decides, because all relevant
  /// windows begin after the end of the log.
  double robustness = 0.0;
  /// Whether the formula holds: robustness > 0, or, if that is 0, a strict or nonstrict comparison
  /// decides: `x <= y` holds for x = y, `x < y` does not.
  bool satisfied = false;
  std::optional<std::size_t> row;  ///< decisive sample, the earliest if there are several
};

/// Evaluates a formula at the first sample. The log must have the formula's signals as columns, and
/// increasing times `t_s` [s]. InputError naming signal and time for a signal that is missing or
/// not finite, a comparison that is not finite (division by zero), times that do not increase, and
/// a log without rows. Cost O(steps x rows) in time for windows of any length (Lemire 2006), and
/// O(depth x rows) in memory.
FormulaResult Evaluate(const Formula& formula, const Table& log);

/// FormulaResult::robustness: > 0 satisfied, < 0 violated. Errors as Evaluate.
double Robustness(const Formula& formula, const Table& log);

/// The robustness at each sample, as if the log began there. Errors as Evaluate.
std::vector<double> RobustnessOverTime(const Formula& formula, const Table& log);

}  // namespace trackbed

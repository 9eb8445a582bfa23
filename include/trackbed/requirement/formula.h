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
/// Bounds a and b count in seconds from the moment at which the formula is evaluated, 0 <= a <= b.
/// A bound may also be `T`, the duration of the log, or `T - c`, at least 0. The default window is
/// [0, T].
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
/// Samples are not interpolated, and the bounds of windows have a tolerance of 1 ns. A window that
/// extends beyond the end of the log is clipped at the end. Without samples in the window, `always`
/// is +infinity, `eventually` and `until` are -infinity, as in RTAMT (Nickovic and Yamaguchi 2020).
namespace trackbed {

/// A bound of a window: a time, or a time before the end of the log.
struct WindowBound {
  double seconds = 0.0;   ///< Time [s], nonnegative.
  bool from_end = false;  ///< Whether the bound is T - seconds.
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

/// One step of a formula in postfix order. The step pops its one or two operands from a stack and
/// pushes its result.
struct FormulaStep {
  FormulaOperation operation = FormulaOperation::kNumber;
  double number = 0.0;     ///< Value of kNumber.
  std::size_t signal = 0;  ///< For kSignal: index in Formula::signals.
  WindowBound from{};      ///< Start of the window of kAlways, kEventually and kUntil.
  WindowBound to{};
  /// Range [begin, end) of the characters of the step and its operands in the formula's text.
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A parsed formula.
class Formula {
 public:
  static constexpr std::size_t kMaxLength = 4096;  ///< Largest length of the text [bytes].
  static constexpr std::size_t kMaxDepth = 50;  ///< Largest nesting of parentheses and operators.

  /// Parses a formula. InputErrors name the column of the text (from 1), the found text and the
  /// alternatives. InputError for a syntax error, and for a signal that is not among `signals`
  /// (with the nearest spelling). InputError for a number where a condition is needed, for a
  /// condition where a number is needed, and for bounds out of order or above 1e6 s. InputError for
  /// a formula without signals, and for a text that exceeds kMaxLength or kMaxDepth. Cost
  /// O(length).
  static Formula Parse(std::string_view text, const std::vector<std::string>& signals);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// The signals of the formula, in order of first use.
  [[nodiscard]] const std::vector<std::string>& signals() const { return signals_; }
  /// The time after a sample within which the log can affect the robustness at the sample [s];
  /// infinity if a bound is missing or relative to the end of the log.
  [[nodiscard]] double horizon_s() const;
  [[nodiscard]] const std::vector<FormulaStep>& steps() const { return steps_; }

 private:
  std::string text_;
  std::vector<std::string> signals_;
  std::vector<FormulaStep> steps_;
};

/// The value of a formula at the first sample of a log.
struct FormulaResult {
  /// Robustness in the unit of the decisive comparison. The robustness is +-infinity if no sample
  /// decides, because all relevant windows begin after the end of the log.
  double robustness = 0.0;
  /// Whether the formula holds, that is, robustness > 0. If the robustness is 0, the kind of
  /// comparison decides: `x <= y` holds for x = y, `x < y` does not.
  bool satisfied = false;
  /// Row of the decisive sample, the earliest if there are several.
  std::optional<std::size_t> row;
};

/// Evaluates a formula at the first sample. The log must have the formula's signals as columns, and
/// increasing times `t_s` [s]. InputError naming signal and time for a signal that is missing or
/// not finite, and for a comparison that is not finite (division by zero). InputError for times
/// that do not increase, and for a log without rows. Cost: O(steps x rows) in time for windows of
/// any length (Lemire 2006), and O(depth x rows) in memory.
FormulaResult Evaluate(const Formula& formula, const Table& log);

/// Returns the robustness at the first sample: > 0 if the formula is satisfied, < 0 if it is
/// violated. Throws the InputErrors of Evaluate.
double Robustness(const Formula& formula, const Table& log);

/// Returns the robustness at each sample, as if the log began with this sample. Throws the
/// InputErrors of Evaluate.
std::vector<double> RobustnessOverTime(const Formula& formula, const Table& log);

}  // namespace trackbed

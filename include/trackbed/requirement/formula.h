#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/table.h"

/// Requirements on logged signals in signal temporal logic, and by how much a log meets them.
///
///     const Formula lane = Formula::Parse("always[0, T] abs(cross_track_m) < 0.5", log.columns());
///     const double margin = Robustness(lane, log);  // > 0: met, with so much to spare
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
/// `T`, the duration of the log, or `T - c`, at least 0. Without them the window is [0, T].
///
/// Semantics (Donzé and Maler 2010; Fainekos and Pappas 2009), over the samples i of a log at times
/// t_i:
///
///     x < y, x <= y         y - x;  x > y, x >= y: x - y
///     not phi               -phi
///     phi and psi           min(phi, psi);  or: max;  implies: max(-phi, psi)
///     always[a, b] phi      minimum of phi over the samples with t_i + a <= t_j <= t_i + b
///     eventually[a, b] phi  maximum likewise
///     phi until[a, b] psi   maximum over these j of min(psi_j, phi_i, …, phi_{j-1})
///
/// Samples are not interpolated, and bounds hold to 1 ns. A window that reaches beyond the end of
/// the log is clipped to it; over one without samples `always` is +infinity, `eventually` and
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

/// One step of a formula in postfix order: it takes its operands, one or two, from a stack and puts
/// its result there.
struct FormulaStep {
  FormulaOperation operation = FormulaOperation::kNumber;
  double number = 0.0;     ///< of kNumber
  std::size_t signal = 0;  ///< of kSignal: index into Formula::signals
  WindowBound from{};      ///< of kAlways, kEventually and kUntil
  WindowBound to{};
  std::size_t begin = 0;  ///< the text that it and its operands stand for, [begin, end)
  std::size_t end = 0;
};

/// A parsed formula.
class Formula {
 public:
  static constexpr std::size_t kMaxLength = 4096;  ///< of the text [bytes]
  static constexpr std::size_t kMaxDepth = 50;     ///< of parentheses and operators in each other

  /// InputError with the column of the text (from 1), what was found and what is allowed: for a
  /// syntax error, a signal that is not among `signals` (with the nearest spelling), a number where
  /// a condition is needed or the reverse, bounds out of order or above 1e6 s, a formula without
  /// signals, and more than kMaxLength and kMaxDepth. Cost O(length).
  static Formula Parse(std::string_view text, const std::vector<std::string>& signals);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// The signals that it uses, in the order of their first use.
  [[nodiscard]] const std::vector<std::string>& signals() const { return signals_; }
  /// How far after a sample its robustness there can depend on the log [s]; infinity if a bound is
  /// relative to the end of the log, or missing.
  [[nodiscard]] double horizon_s() const;
  [[nodiscard]] const std::vector<FormulaStep>& steps() const { return steps_; }

 private:
  std::string text_;
  std::vector<std::string> signals_;
  std::vector<FormulaStep> steps_;
};

/// What a formula is worth at the first sample of a log.
struct FormulaResult {
  /// In the unit of the comparison that decides; +-infinity if no sample decides, because all
  /// windows that matter begin after the end of the log.
  double robustness = 0.0;
  /// Whether it holds. The same as robustness > 0, but where this is 0: `x <= y` holds for x = y,
  /// `x < y` does not.
  bool satisfied = false;
  std::optional<std::size_t> row;  ///< sample that decides, the earliest of several; if any
};

/// Evaluates a formula at the first sample. The log has the formula's signals as columns, and
/// `t_s`, increasing [s]. InputError naming signal and time for a signal that is missing or not
/// finite, a comparison that is not finite (a division by zero), times that do not increase, and a
/// log without rows. Cost O(steps x rows) in time, windows of any length included (Lemire 2006),
/// and O(depth x rows) in memory.
FormulaResult Evaluate(const Formula& formula, const Table& log);

/// FormulaResult::robustness: > 0 satisfied, < 0 violated. Errors as Evaluate.
double Robustness(const Formula& formula, const Table& log);

/// The robustness at each sample, as if the log began there. Errors as Evaluate.
std::vector<double> RobustnessOverTime(const Formula& formula, const Table& log);

}  // namespace trackbed

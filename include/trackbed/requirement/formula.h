#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Requirements on logged signals, as formulas of signal temporal logic, and the robustness of
/// these formulas on a log.
///
///     const Formula lane = Formula::Parse("always[0, T] abs(cross_track_m) < 0.5", log.columns());
///     const double margin = Robustness(lane, log);  // > 0: met with this margin
///
/// This grammar lists the operators from the weakest to the strongest
/// (docs/how-to/requirements.md):
///
///     phi implies psi                      right associative
///     phi or psi,  phi and psi
///     phi until[a, b] psi                  not associative
///     not phi,  always[a, b] phi,  eventually[a, b] phi
///     x < y,  x <= y,  x > y,  x >= y
///     x + y,  x - y,  x * y,  x / y,  -x
///     number, signal, abs(x), min(x, y, …), max(x, y, …), ( )
///
/// The bounds a and b of a window are times in seconds after the time at which the formula is
/// evaluated, with 0 <= a <= b. A bound of a window may also be `T`, the duration of the log, or `T
/// - c` for a number c; a negative `T - c` is replaced by 0. An operator without a window has the
/// window [0, T], the whole log.
///
/// This table states the value of each formula at the sample i of a log, at the time t_i (Donzé and
/// Maler 2010; Fainekos and Pappas 2009):
///
///     x < y, x <= y         y - x;  x > y, x >= y: x - y
///     not phi               -phi
///     phi and psi           min(phi, psi);  or: max;  implies: max(-phi, psi)
///     always[a, b] phi      minimum of phi over the samples with t_i + a <= t_j <= t_i + b
///     eventually[a, b] phi  maximum of phi over these samples
///     phi until[a, b] psi   maximum over these j of min(psi_j, phi_i, …, phi_{j-1})
///
/// Formulas are not evaluated between samples, and the bounds of windows have a tolerance of 1 ns.
/// A window that extends beyond the end of the log is shortened to end with the log. If a window
/// contains no samples, the value of `always` is +infinity and the value of `eventually` and
/// `until` is -infinity, as in RTAMT (Nickovic and Yamaguchi 2020).
namespace trackbed {

/// A bound of a window: a time after the time of evaluation, or T minus a time, where T is the
/// duration of the log.
struct WindowBound {
  double seconds = 0.0;  ///< Time [s], nonnegative.
  /// If `from_end` is true, the bound of the window is T - `seconds`, with the duration T of the
  /// log; otherwise the bound is `seconds`.
  bool from_end = false;
};

/// The operations that can occur in a formula.
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

/// One step of a formula; the steps are stored in postfix order. The evaluation of a step pops up
/// to two operands from a stack, and pushes the result of the step.
struct FormulaStep {
  FormulaOperation operation = FormulaOperation::kNumber;
  double number = 0.0;     ///< Value of the number, for the operation kNumber.
  std::size_t signal = 0;  ///< Index of the signal in Formula::signals, for the operation kSignal.
  /// Start of the time window, for the operations kAlways, kEventually and kUntil.
  WindowBound from{};
  WindowBound to{};
  /// Range [begin, end) of characters in the formula's text that contains the step and the step's
  /// operands.
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A parsed formula.
class Formula {
 public:
  /// Maximum length of the text of a formula [bytes].
  static constexpr std::size_t kMaxLength = 4096;
  /// Maximum nesting depth of parentheses and operators in a formula.
  static constexpr std::size_t kMaxDepth = 50;

  /// Parses the text of a formula. The message of an InputError states the column in the text (from
  /// 1), the invalid text and the alternatives. Throws InputError if the text has a syntax error,
  /// or names a signal that is not in `signals` (the message suggests the most similar name).
  /// Throws InputError if a number is given where a condition is needed or vice versa, or if the
  /// bounds of a window are out of order or above 1e6 s. Throws InputError if the formula has no
  /// signals, or if the text exceeds kMaxLength or kMaxDepth. The parsing time is proportional to
  /// the length of the text.
  static Formula Parse(std::string_view text, const std::vector<std::string>& signals);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// Returns the names of the signals in the formula, in the order of their first use.
  [[nodiscard]] const std::vector<std::string>& signals() const { return signals_; }
  /// Returns the time after a sample within which the log can affect the formula's robustness at
  /// this sample [s]. Returns infinity if a window's bound is missing or relative to the end of the
  /// log.
  [[nodiscard]] double horizon_s() const;
  [[nodiscard]] const std::vector<FormulaStep>& steps() const { return steps_; }

 private:
  std::string text_;
  std::vector<std::string> signals_;
  std::vector<FormulaStep> steps_;
};

}  // namespace trackbed

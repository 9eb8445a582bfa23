#pragma once

#include <cstddef>

namespace trackbed {

enum class ProbabilityVerdict {
  kUndecided,
  kAtLeast,  ///< The probability is at least the claimed one.
  kBelow,    ///< The probability is below the claimed one.
};

/// Decides from a sequence of successes and failures whether the probability of success is at least
/// a given value. The sequence may stop after any trial.
///
/// Uses Robbins' (1970) mixture of Wald's (1947) sequential probability ratio tests. With s
/// successes, f failures and P = `probability`, the likelihood ratio L compares all probabilities q
/// above P, equally weighted, with P itself:
///
///     L = integral from P to 1 of q^s (1 - q)^f dq / ((1 - P) P^s (1 - P)^f)
///
/// The ratio M is defined in the same way for all q below P. The verdict is `kAtLeast` as soon as L
/// >= 1/(1 - confidence), and `kBelow` as soon as M >= 1/(1 - confidence).
///
/// Guarantees: each of the two wrong claims has a probability of at most 1 - confidence, for
/// independent trials with the same probability. If the true probability is at most P, L is a
/// nonnegative supermartingale with a mean of at most 1. The probability that L ever reaches 1/(1 -
/// confidence), after any number of looks, is then at most 1 - confidence (Ville 1939). Likewise, M
/// is such a supermartingale if the true probability is at least P. Wald's test needs a second
/// probability and guarantees nothing if the true probability lies between P and the second one;
/// this test needs no second probability. If the true probability is very near P, the test needs
/// many trials. If the true probability equals P, the test mostly stays undecided.
///
/// Without a failure, P = 0.99 at 95 % confidence needs 449 trials. A test that may not stop early
/// needs 299 trials.
class SequentialTest {
 public:
  /// PreconditionError unless both arguments are in (0, 1).
  SequentialTest(double probability, double confidence);

  void Add(bool success);

  [[nodiscard]] ProbabilityVerdict verdict() const { return verdict_; }
  /// The number of trials until the verdict; while undecided, the number of all trials.
  [[nodiscard]] std::size_t trials() const { return successes_ + failures_; }
  [[nodiscard]] std::size_t successes() const { return successes_; }
  [[nodiscard]] std::size_t failures() const { return failures_; }

  /// Natural logarithms of the likelihood ratios L (LogAbove) and M (LogBelow).
  [[nodiscard]] double LogAbove() const;
  [[nodiscard]] double LogBelow() const;

 private:
  double probability_;
  double confidence_;
  std::size_t successes_ = 0;
  std::size_t failures_ = 0;
  ProbabilityVerdict verdict_ = ProbabilityVerdict::kUndecided;
};

}  // namespace trackbed

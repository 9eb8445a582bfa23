#pragma once

#include <cstddef>

namespace trackbed {

enum class ProbabilityVerdict {
  kUndecided,
  kAtLeast,  ///< The probability of success is at least the claimed probability.
  kBelow,    ///< The probability of success is below the claimed probability.
};

/// Decides from a sequence of successes and failures whether the probability of success is at least
/// a given value. The trials may be stopped after any trial, depending on the results so far.
///
/// Uses Robbins' (1970) mixture of Wald's (1947) sequential probability ratio tests. With s
/// successes, f failures and P = `probability`, the likelihood ratio L compares the likelihood of
/// all probabilities q above P, equally weighted, with the likelihood of P itself:
///
///     L = integral from P to 1 of q^s (1 - q)^f dq / ((1 - P) P^s (1 - P)^f)
///
/// The likelihood ratio M is defined like L, but for all q below P. The verdict is `kAtLeast` as
/// soon as the likelihood ratio L >= 1/(1 - confidence), and `kBelow` as soon as the ratio M >=
/// 1/(1 - confidence).
///
/// Guarantees: if the trials are independent and have the same probability of success, each of the
/// two verdicts is wrong with a probability of at most 1 - confidence. If the true probability is
/// at most P, the likelihood ratio L is a nonnegative supermartingale with a mean of at most 1. If
/// the true probability is at most P, the likelihood ratio L ever reaches 1/(1 - confidence) with a
/// probability of at most 1 - confidence (Ville 1939). If the true probability is at least P, the
/// likelihood ratio M is a nonnegative supermartingale with a mean of at most 1. Unlike
/// SequentialTest, Wald's test needs a second probability besides P, and guarantees nothing if the
/// true probability lies between P and the second probability. If the true probability of success
/// is very near the claimed probability P, the test needs many trials. If the true probability
/// equals P, the test usually reaches no verdict.
///
/// If no trial fails, the test needs 449 trials for the verdict that the probability of success is
/// at least 0.99, with 95 % confidence. With 299 passing trials, a test with a fixed number of
/// trials shows that the probability of success is at least 0.99, with 95 % confidence.
class SequentialTest {
 public:
  /// Throws PreconditionError unless both arguments are in (0, 1).
  SequentialTest(double probability, double confidence);

  void Add(bool success);

  [[nodiscard]] ProbabilityVerdict verdict() const { return verdict_; }
  /// Returns the number of trials until the verdict; before a verdict, returns the number of all
  /// trials so far.
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

#pragma once

#include <cstddef>

namespace trackbed {

enum class ProbabilityVerdict {
  kUndecided,
  kAtLeast,  ///< the probability is at least the one claimed
  kBelow,    ///< it is below
};

/// Decides from a sequence of successes and failures whether the probability of success is at least
/// a given value, and may stop after any of them.
///
/// Robbins' (1970) mixture of Wald's (1947) sequential probability ratio tests. With s successes
/// and f failures and P = `probability`, the likelihood of all q above P, equally weighted,
/// relative to that of P is
///
///     L = integral from P to 1 of q^s (1 - q)^f dq / ((1 - P) P^s (1 - P)^f)
///
/// M is defined in the same way for all q below P. The verdict is `kAtLeast` at the first L >= 1/(1
/// - confidence), `kBelow` at the first M >= 1/(1 - confidence).
///
/// Guarantees: while the true probability is at most P, L is a nonnegative supermartingale with
/// mean 1 at most, so that the probability that it ever reaches 1/(1 - confidence), for any number
/// of looks, is at most 1 - confidence (Ville 1939); the same holds for M while the true
/// probability is at least P. Each of the two wrong claims is therefore made with a probability of
/// at most 1 - confidence, for independent trials with the same probability. Wald's test needs a
/// second probability and guarantees nothing between it and P; this test does not. A probability
/// very near P needs many trials, and one equal to P mostly stays undecided.
///
/// Without a failure, P = 0.99 at 95 % needs 449 trials; a test that may not stop early needs 299.
class SequentialTest {
 public:
  /// PreconditionError unless both are in (0, 1).
  SequentialTest(double probability, double confidence);

  void Add(bool success);

  [[nodiscard]] ProbabilityVerdict verdict() const { return verdict_; }
  /// Trials until the verdict; all trials while undecided.
  [[nodiscard]] std::size_t trials() const { return successes_ + failures_; }
  [[nodiscard]] std::size_t successes() const { return successes_; }
  [[nodiscard]] std::size_t failures() const { return failures_; }

  /// Natural logarithms of L and M.
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

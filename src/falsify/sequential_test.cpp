#include "trackbed/falsify/sequential_test.h"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Boost policy that avoids long doubles, whose tables in Boost overflow under valgrind (as in
/// statistics.cpp).
using DoublePrecision = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// Returns the logarithm of a likelihood ratio. The numerator of the ratio is the mean likelihood
/// of all probabilities q below p (or above p, if `above` is set). The denominator of the ratio is
/// the likelihood of p. The likelihood of a probability q is q^s (1 - q)^f for s successes and f
/// failures.
double LogRatio(double successes, double failures, double p, bool above) {
  const DoublePrecision policy;
  const double a = successes + 1.0;
  const double b = failures + 1.0;
  const double share =
      above ? boost::math::ibetac(a, b, p, policy) : boost::math::ibeta(a, b, p, policy);
  if (share < std::numeric_limits<double>::min()) {
    // Return -infinity if the likelihood ratio underflows to 0; the test then remains undecided.
    return -std::numeric_limits<double>::infinity();
  }
  const double log_beta = boost::math::lgamma(a, policy) + boost::math::lgamma(b, policy) -
                          boost::math::lgamma(a + b, policy);
  return std::log(share) + log_beta - std::log(above ? 1.0 - p : p) - successes * std::log(p) -
         failures * std::log1p(-p);
}

}  // namespace

SequentialTest::SequentialTest(double probability, double confidence)
    : probability_(probability), confidence_(confidence) {
  TRACKBED_REQUIRE(probability > 0.0 && probability < 1.0 && confidence > 0.0 && confidence < 1.0,
                   "SequentialTest: probability {}, confidence {}", probability, confidence);
}

void SequentialTest::Add(bool success) {
  if (verdict_ != ProbabilityVerdict::kUndecided) {
    return;
  }
  (success ? successes_ : failures_) += 1;
  const double enough = -std::log1p(-confidence_);
  if (LogAbove() >= enough) {
    verdict_ = ProbabilityVerdict::kAtLeast;
  } else if (LogBelow() >= enough) {
    verdict_ = ProbabilityVerdict::kBelow;
  }
}

double SequentialTest::LogAbove() const {
  return LogRatio(static_cast<double>(successes_), static_cast<double>(failures_), probability_,
                  true);
}

double SequentialTest::LogBelow() const {
  return LogRatio(static_cast<double>(successes_), static_cast<double>(failures_), probability_,
                  false);
}

}  // namespace trackbed

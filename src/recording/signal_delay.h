#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// Delay by which a signal lags behind a reference.
struct SignalDelay {
  double delay = 0.0;  ///< Delay of the signal [s]; negative if the signal precedes the reference.
  double standard_error = 0.0;  ///< Standard error of the delay [s].
};

/// The largest delay that FindDelay detects [s].
inline constexpr double kMaxSignalDelay = 1.0;

/// Estimates the delay tau of the model
///   signal(t) = a reference(t - tau) + b + noise,
/// where tau minimizes the sum of squared residuals over the valid samples. The constants a > 0 and
/// b of the model are fitted, so a wrong scale or offset of the signal has no effect on the delay.
/// The standard error of the delay is
///   sqrt(V)/H,  V = variance of sum_i e_i x'_i,  H = a |sum_i (x_i - mean) x''_i|,
/// with the residuals e and the reference x. The variance V is estimated from the autocorrelation
/// of the products e_i x'_i of residual and reference slope (Newey and West 1987), because smoothed
/// noise is correlated. The number H is the curvature of the correlation of signal and reference,
/// so noise of the reference does not increase H. If the reference is linear in time, H is 0 and
/// the standard error is infinite.
///
/// For periodic motion, several delays fit. If their sums of squared residuals do not differ
/// significantly (three standard deviations), FindDelay returns the smallest absolute delay.
///
/// If the delay model explains less than 0.8 of the signal's variance, signal and reference are
/// smoothed by moving averages. The moving averages extend over up to half of kMaxSignalDelay to
/// either side.
///
/// Consecutive samples are `period` [s] apart in time. FindDelay returns nullopt if the model
/// explains less than a tenth of the signal's variance, or hardly more than pure noise would
/// explain at its best delay. FindDelay also returns nullopt if the best delay exceeds
/// kMaxSignalDelay, or if there are fewer than 4 kMaxSignalDelay/period samples. The computing time
/// of FindDelay is at most 1.5 s.
std::optional<SignalDelay> FindDelay(const std::vector<double>& reference,
                                     const std::vector<double>& signal,
                                     const std::vector<bool>& valid, double period);

}  // namespace trackbed

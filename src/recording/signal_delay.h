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
/// b are free, so a wrong scale or offset of the signal has no effect. The standard error is
///   sqrt(V)/H,  V = variance of sum_i e_i x'_i,  H = a |sum_i (x_i - mean) x''_i|,
/// with the residuals e and the reference x. V is estimated from the correlation of the products
/// e_i x'_i over time (Newey and West 1987), because smoothed noise is correlated. H is the
/// curvature of the correlation of signal and reference, so noise of the reference does not
/// increase H. For a reference that is linear in time, H is 0 and the standard error is infinite.
///
/// Periodic motion fits at several delays. If the sums of squared residuals of these delays do not
/// differ significantly (three standard deviations), the smallest absolute delay is returned.
///
/// If the model explains less than 0.8 of the signal's variance, signal and reference are smoothed
/// by moving averages. The moving averages extend over up to half of kMaxSignalDelay to either
/// side.
///
/// All samples have the same distance `period` [s] in time. Returns nullopt if the model explains
/// less than a tenth of the signal's variance. Also returns nullopt if pure noise would explain
/// nearly as much at its best delay. Also returns nullopt if the best delay exceeds
/// kMaxSignalDelay, or if there are fewer than 4 kMaxSignalDelay/period samples. The computing time
/// is at most 1.5 s.
std::optional<SignalDelay> FindDelay(const std::vector<double>& reference,
                                     const std::vector<double>& signal,
                                     const std::vector<bool>& valid, double period);

}  // namespace trackbed

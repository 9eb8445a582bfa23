#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// By how much a signal lags a reference.
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
///   sigma / (a |d|) sqrt((1 + rho)/(1 - rho)),
/// with the standard deviation sigma of the residuals, their correlation rho between neighboring
/// samples, and the part d of the reference's derivative that is orthogonal to the reference and to
/// a constant.
///
/// All samples have the same distance `period` [s] in time. Returns nullopt if the model explains
/// less than half of the signal's variance, if the best delay exceeds kMaxSignalDelay, or if there
/// are fewer than 4 kMaxSignalDelay/period samples. The cost is at most 0.1 s.
std::optional<SignalDelay> FindDelay(const std::vector<double>& reference,
                                     const std::vector<double>& signal,
                                     const std::vector<bool>& valid, double period);

}  // namespace trackbed

#include "trackbed/control/steering_profile.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

double Phase(const SweptSineOptions& options, double tau) {
  const double f0 = options.start_frequency;
  const double f1 = options.end_frequency;
  if (options.sweep == Sweep::kLinear) {
    return 2.0 * kPi * (f0 + 0.5 * (f1 - f0) * tau / options.duration) * tau;
  }
  // (e^k - 1)/k keeps its digits where the frequencies are close, and is 1 where they are equal.
  const double k = std::log(f1 / f0) * tau / options.duration;
  return 2.0 * kPi * f0 * tau * (k == 0.0 ? 1.0 : std::expm1(k) / k);
}

/// From 0 toward `end` at `rate` since tau = 0.
double Ramp(double end, double rate, double tau) {
  return std::copysign(std::clamp(rate * tau, 0.0, std::abs(end)), end);
}

}  // namespace

double SteeringAt(const ConstantSteeringOptions& options, double) {
  return options.steering;
}

double SteeringAt(const StepSteeringOptions& options, double time) {
  const double tau = time - options.at;
  if (options.rate) {
    return Ramp(options.amplitude, *options.rate, tau);
  }
  constexpr double kSameTime = 1e-9;  // [s]
  return tau < kSameTime ? 0.0 : options.amplitude;
}

double SteeringAt(const RampSteeringOptions& options, double time) {
  return Ramp(options.end, options.rate, time - options.at);
}

double SteeringAt(const SineSteeringOptions& options, double time) {
  const double turns = options.frequency * (time - options.at);
  return turns > 0.0 && turns < options.cycles ? options.amplitude * std::sin(2.0 * kPi * turns)
                                               : 0.0;
}

double SteeringAt(const SineWithDwellOptions& options, double time) {
  const double tau = time - options.at;
  const double peak = 0.75 / options.frequency;
  // The sine's own time stands still during the dwell.
  const double own = tau < peak ? tau : std::max(peak, tau - options.dwell);
  const double turns = options.frequency * own;
  return turns > 0.0 && turns < 1.0 ? options.amplitude * std::sin(2.0 * kPi * turns) : 0.0;
}

double SteeringAt(const SweptSineOptions& options, double time) {
  const double tau = time - options.at;
  return tau > 0.0 && tau < options.duration ? options.amplitude * std::sin(Phase(options, tau))
                                             : 0.0;
}

}  // namespace trackbed

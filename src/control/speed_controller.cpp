#include "trackbed/control/speed_controller.h"

#include <algorithm>
#include <limits>

namespace trackbed {
namespace {

/// Returns the mean acceleration of the speed profile over the next control period [m/s^2]. A car
/// with this mean acceleration has the profile's speed at the end of the period, even if the
/// profile has a knot within the period.
double MeanAcceleration(const SpeedProfile& profile, double s, double speed, double period,
                        double at_middle) {
  double acceleration = at_middle;
  // Each iteration divides the error of the mean acceleration by about speed/(acceleration *
  // period).
  constexpr int kIterations = 3;
  for (int i = 0; i < kIterations; ++i) {
    const double next = s + period * (speed + 0.5 * period * acceleration);
    acceleration = (profile.SpeedAt(next) - profile.SpeedAt(s)) / period;
  }
  return acceleration;
}

/// Tolerance of the acceleration options: a speed profile whose acceleration exceeds an option by
/// more than this factor does so on purpose.
constexpr double kOnPurpose = 1.1;
/// Maximum ratio of the commanded acceleration to the profile's acceleration; above 1, so that the
/// car can catch up with the profile. For a speed profile at 0.9 of the tyres' limit, the factor
/// 1.05 uses half of the remaining margin. A factor much above 1 would be risky, because a locked
/// or spinning wheel regains grip only when the commanded acceleration falls.
constexpr double kCatchUp = 1.05;

/// Returns the deceleration at the end of a speed profile that ends at rest [m/s^2], >= 0.
double LastDeceleration(const SpeedProfile& profile) {
  const auto& knots = profile.knots();
  return knots.size() < 2 ? 0.0 : -profile.AccelerationAt(knots[knots.size() - 2].s);
}

}  // namespace

double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period, double max_deceleration) {
  const double limit =
      max_deceleration > 0.0 ? max_deceleration : std::numeric_limits<double>::infinity();
  const auto on_purpose = [&](double deceleration) {
    return deceleration > kOnPurpose * options.deceleration;
  };
  const bool stops = !profile.knots().empty() && profile.knots().back().speed == 0.0;
  const double end = profile.knots().empty() ? 0.0 : profile.knots().back().s;
  if (stops && s >= end) {
    const double last = LastDeceleration(profile);
    return -std::min(on_purpose(last) ? last : options.deceleration, limit);
  }
  // Before the start of the speed profile, use the profile's acceleration at its start.
  const double from = profile.knots().empty() ? s : std::max(s, profile.knots().front().s);
  // For a car that rolls backward, use the profile's acceleration at the car's present station.
  const double ahead = std::max(speed, 0.0);
  // Evaluate the profile's acceleration at the middle of the period, but not beyond the profile's
  // end, because the profile has no acceleration there.
  double middle = from + 0.5 * ahead * period;
  if (stops) {
    middle = std::min(middle, 0.5 * (from + end));
  }
  const bool ends = stops && from + ahead * period >= end;
  const double at_middle = profile.AccelerationAt(middle);
  // A car before the start of the speed profile does not move along the profile, so its speed does
  // not determine the profile's mean acceleration.
  const double feed_forward =
      ends || from > s ? at_middle : MeanAcceleration(profile, from, ahead, period, at_middle);
  const double error = profile.SpeedAt(s) - speed;
  const double hard = on_purpose(-feed_forward) ? -kCatchUp * feed_forward : 0.0;
  const double hardest = std::min(std::max(2.0 * options.deceleration, hard), limit);
  // Compare the profile's acceleration at the middle of the period and not the mean, because the
  // mean acceleration over the period may be larger when the car starts from rest.
  const double strongest =
      at_middle > kOnPurpose * options.acceleration ? kCatchUp * at_middle : options.acceleration;
  return std::clamp(feed_forward + options.gain * error, -hardest, strongest);
}

bool BrakingHasBegun(const SpeedControlOptions& options, double time) {
  constexpr double kSameTime = 1e-9;  // [s]
  return options.braking && time >= options.braking->at - kSameTime;
}

bool Coasts(const SpeedControlOptions& options, double time) {
  return BrakingHasBegun(options, time) && options.braking->deceleration == 0.0;
}

std::optional<double> TimedSpeedControl(const SpeedControlOptions& options, double time,
                                        double speed, double period) {
  if (BrakingHasBegun(options, time)) {
    return -options.braking->deceleration;
  }
  if (!options.over_time.empty()) {
    return SpeedAlong(options.over_time, time, period, options.gain, speed, period);
  }
  return std::nullopt;
}

double SpeedAlong(const Signal& wanted, double x, double ahead, double gain, double speed,
                  double period) {
  const double now = wanted.At(x);
  return (wanted.At(x + ahead) - now) / period + gain * (now - speed);
}

}  // namespace trackbed

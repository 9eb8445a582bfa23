#include "trackbed/control/speed_controller.h"

#include <algorithm>

namespace trackbed {

double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period) {
  const bool stops = !profile.knots().empty() && profile.knots().back().speed == 0.0;
  const double end = profile.knots().empty() ? 0.0 : profile.knots().back().s;
  if (stops && s >= end) {
    return -options.deceleration;
  }
  // A car that stands a hair behind the start leaves like one that stands at it.
  const double from = profile.knots().empty() ? s : std::max(s, profile.knots().front().s);
  // The middle of the period, but not beyond the end: there is no acceleration to be had there.
  double middle = from + 0.5 * speed * period;
  if (stops) {
    middle = std::min(middle, 0.5 * (from + end));
  }
  const double feed_forward = profile.AccelerationAt(middle);
  const double error = profile.SpeedAt(s) - speed;
  return std::clamp(feed_forward + options.gain * error, -2.0 * options.deceleration,
                    options.acceleration);
}

std::optional<double> TimedSpeedControl(const SpeedControlOptions& options, double time,
                                        double speed, double period) {
  constexpr double kSameTime = 1e-9;  // [s]
  if (options.braking && time >= options.braking->at - kSameTime) {
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

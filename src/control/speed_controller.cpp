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

}  // namespace trackbed

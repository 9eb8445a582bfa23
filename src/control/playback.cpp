#include "trackbed/control/playback.h"

#include <cmath>

#include "trackbed/control/speed_controller.h"

namespace trackbed {
namespace {

/// How far the axis goes within the period.
double Ahead(const PlaybackOptions& options, double speed, double period) {
  return options.by == PlaybackAxis::kTime ? period : std::abs(speed) * period;
}

}  // namespace

double PlaybackSteering(const PlaybackOptions& options, double x, double speed, double period) {
  return options.recording.steering.At(x + Ahead(options, speed, period));
}

std::optional<double> PlaybackAcceleration(const PlaybackOptions& options, double x, double speed,
                                           double gain, double period) {
  const Recording& recording = options.recording;
  const double ahead = Ahead(options, speed, period);
  if (!recording.speed.empty()) {
    return SpeedAlong(recording.speed, x, ahead, gain, std::abs(speed), period);
  }
  if (!recording.acceleration.empty()) {
    return recording.acceleration.Mean(x, x + ahead);
  }
  return std::nullopt;
}

}  // namespace trackbed

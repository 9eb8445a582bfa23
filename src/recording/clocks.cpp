#include "src/recording/clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/recording/fitted_series.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {
namespace {

using Values = std::vector<double>;

double MeanStep(const Values& time) {
  return time.size() < 2 ? 0.0
                         : (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

/// The motion of the car over the samples of the drive.
struct Motion {
  Values speed;
  Values lateral_speed;  // of the rear axle
  Values yaw_rate;
};

class Clocks {
 public:
  Clocks(const LogRows& rows, const LogMap& map, const RecordedDrive& drive, double start)
      : rows_(rows), map_(map), drive_(drive), start_(start) {
    for (const RecordedSample& sample : drive.samples) {
      valid_.push_back(sample.valid);
      pose_.speed.push_back(sample.velocity_V.x());
      pose_.lateral_speed.push_back(sample.velocity_V.y());
      pose_.yaw_rate.push_back(sample.yaw_rate);
    }
  }

  std::vector<SignalClock> Measure() {
    motion_.speed = CompareMotion(kSpeedSignal, pose_.speed);
    motion_.yaw_rate = CompareMotion(kYawRateSignal, pose_.yaw_rate);
    if (rows_.has[kAccelerationX]) {
      CompareAccelerations();
    }
    CompareSteering(kSteeringSignal);
    CompareSteering(kSteeringCommandSignal);
    return std::move(clocks_);
  }

 private:
  [[nodiscard]] double LogTime(std::size_t sample) const {
    return start_ + drive_.samples[sample].time;
  }

  /// Returns the values of a signal at the samples, `later` [s] after the time of each sample.
  [[nodiscard]] Values Of(LogSignal signal, double later = 0.0) const {
    const FittedSeries fits(rows_.signals[signal], map_);
    Values values;
    for (std::size_t i = 0; i < drive_.samples.size(); ++i) {
      values.push_back(fits.At(LogTime(i) + later)(0, 0));
    }
    return values;
  }

  /// Returns the derivatives of values with respect to time, by central differences over `reach`
  /// samples to either side.
  [[nodiscard]] Values Derivative(const Values& values, std::size_t reach = 1) const {
    Values rates;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t before = i < reach ? 0 : i - reach;
      const std::size_t after = std::min(i + reach, values.size() - 1);
      const double time = static_cast<double>(after - before) * drive_.period;
      rates.push_back((values[after] - values[before]) / time);
    }
    return rates;
  }

  /// Adds the delay by which `values` follow `reference`; `values` are computed from `signal`.
  void Add(LogSignal signal, const Values& reference, const Values& values) {
    if (const auto found = FindDelay(reference, values, valid_, drive_.period)) {
      clocks_.push_back({.signal = signal,
                         .found = *found,
                         .uncertainty = std::max({3.0 * found->standard_error, MeanStep(rows_.time),
                                                  MeanStep(rows_.signals[signal].time)})});
    }
  }

  /// Compares a signal with the same quantity computed from the pose. Returns the signal without
  /// its delay. If the log does not have the signal, or if the signal does not fit, returns the
  /// quantity computed from the pose.
  Values CompareMotion(LogSignal signal, const Values& reference) {
    if (!rows_.has[signal]) {
      return reference;
    }
    const std::size_t before = clocks_.size();
    Add(signal, reference, Of(signal));
    return clocks_.size() > before ? Of(signal, clocks_.back().found.delay) : reference;
  }

  void CompareAccelerations();
  void CompareSteering(LogSignal signal);

  const LogRows& rows_;
  const LogMap& map_;
  const RecordedDrive& drive_;
  double start_;
  std::vector<bool> valid_;
  Motion pose_;    // Motion computed from the pose.
  Motion motion_;  // Measured motion, on the clock of the pose.
  std::vector<SignalClock> clocks_;
};

void Clocks::CompareAccelerations() {
  const double ahead = map_.accelerometer->ahead;
  const double left = map_.accelerometer->left;
  const Values speed_rate = Derivative(motion_.speed);
  const Values yaw_acceleration = Derivative(motion_.yaw_rate);
  // The lateral speed is computed from the pose; its derivative over neighboring samples would be
  // the second derivative of a noisy position.
  const auto reach =
      static_cast<std::size_t>(std::max(1.0, std::round(map_.resample.half_width / drive_.period)));
  const Values lateral_rate = Derivative(pose_.lateral_speed, reach);
  Values x;
  Values y;
  for (std::size_t i = 0; i < speed_rate.size(); ++i) {
    const double r = motion_.yaw_rate[i];
    x.push_back(speed_rate[i] - pose_.lateral_speed[i] * r - r * r * ahead -
                yaw_acceleration[i] * left);
    y.push_back(motion_.speed[i] * r + lateral_rate[i] + yaw_acceleration[i] * ahead -
                r * r * left);
  }
  Add(kAccelerationX, x, Of(kAccelerationX));
  Add(kAccelerationY, y, Of(kAccelerationY));
}

void Clocks::CompareSteering(LogSignal signal) {
  if (!rows_.has[signal]) {
    return;
  }
  // The yaw rate is nearly proportional to the speed times the tangent of the steering angle.
  Values turning = Of(signal);
  for (std::size_t i = 0; i < turning.size(); ++i) {
    turning[i] = pose_.speed[i] * std::tan(turning[i]);
  }
  Add(signal, turning, pose_.yaw_rate);
}

bool IsSteering(LogSignal signal) {
  return signal == kSteeringSignal || signal == kSteeringCommandSignal;
}

double DelayInMap(const LogMap& map, LogSignal signal) {
  switch (signal) {
    case kSpeedSignal:
      return map.speed->delay;
    case kYawRateSignal:
      return map.yaw_rate->delay;
    case kSteeringSignal:
      return map.steering->delay;
    case kSteeringCommandSignal:
      return map.steering_command->delay;
    default:
      return map.accelerometer->delay;
  }
}

/// Returns the delay [s] that no car can cause: any delay of a motion signal behind the pose, or a
/// delay of the steering behind the yaw rate. Returns nullopt if the delay is one that a car can
/// cause.
std::optional<double> Contradiction(const SignalClock& clock) {
  const double delay = clock.found.delay;
  if (!IsSteering(clock.signal)) {
    return delay;
  }
  return delay < 0.0 ? std::optional(-delay) : std::nullopt;
}

std::string Describe(const SignalClock& clock) {
  const double delay = clock.found.delay;
  const std::string size = fmt::format("{:.3g} s (standard error {:.2g} s)", std::abs(delay),
                                       clock.found.standard_error);
  const char* key = kLogSignalKeys[clock.signal];
  if (IsSteering(clock.signal)) {
    return delay > 0.0 ? fmt::format(
                             "the yaw rate follows {} by {}; the response of the car is a "
                             "part of this delay",
                             key, size)
                       : fmt::format(
                             "the yaw rate precedes {} by {}, which a car cannot do: the "
                             "steering is logged late",
                             key, size);
  }
  const char* axis = clock.signal == kAccelerationX   ? ".x"
                     : clock.signal == kAccelerationY ? ".y"
                                                      : "";
  return fmt::format("{}{} {} the motion of the pose by {}", key, axis,
                     delay > 0.0 ? "lags" : "precedes", size);
}

}  // namespace

bool SignalClock::differs() const {
  return std::abs(found.delay) > uncertainty;
}

std::vector<SignalClock> MeasureClocks(const LogRows& rows, const LogMap& map,
                                       const RecordedDrive& drive, double start) {
  return Clocks(rows, map, drive, start).Measure();
}

std::vector<std::string> CompareClocks(LogRows& rows, const LogMap& map, const RecordedDrive& drive,
                                       double start) {
  std::vector<std::string> notes;
  for (const SignalClock& clock : MeasureClocks(rows, map, drive, start)) {
    if (!clock.differs()) {
      continue;
    }
    const std::string what = Describe(clock);
    const std::optional<double> delay = Contradiction(clock);
    if (delay && map.align) {
      for (double& time : rows.signals[clock.signal].time) {
        time -= *delay;
      }
      notes.push_back(what + ": shifted by this delay");
    } else if (delay) {
      notes.push_back(fmt::format("{}: shift it with --align, or set {}.delay: {:.3g} in the map",
                                  what, kLogSignalKeys[clock.signal],
                                  DelayInMap(map, clock.signal) + *delay));
    } else {
      notes.push_back(what);
    }
  }
  return notes;
}

}  // namespace trackbed

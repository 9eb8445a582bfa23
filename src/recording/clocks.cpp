#include "src/recording/clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/recording/fitted_series.h"
#include "src/recording/signal_delay.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {
namespace {

class Clocks {
 public:
  Clocks(LogRows& rows, const LogMap& map, const RecordedDrive& drive, double start)
      : rows_(rows), map_(map), drive_(drive), start_(start) {
    for (const RecordedSample& sample : drive.samples) {
      valid_.push_back(sample.valid);
    }
  }

  std::vector<std::string> Compare();

 private:
  /// Returns one value of each sample.
  template <typename Value>
  [[nodiscard]] std::vector<double> Of(const Value& value) const {
    std::vector<double> values;
    for (const RecordedSample& sample : drive_.samples) {
      values.push_back(value(sample));
    }
    return values;
  }

  [[nodiscard]] double LogTime(const RecordedSample& sample) const { return start_ + sample.time; }

  /// Returns the largest error of a delay that is to be expected [s]: twice the standard error, or
  /// half of the mean distance between two rows if that is more.
  [[nodiscard]] double Uncertainty(const SignalDelay& found) const {
    const double rows = static_cast<double>(rows_.time.size() - 1);
    return std::max(2.0 * found.standard_error,
                    0.5 * (rows_.time.back() - rows_.time.front()) / rows);
  }

  /// Estimates a delay; nullopt unless it exceeds its uncertainty.
  [[nodiscard]] std::optional<SignalDelay> Find(const std::vector<double>& reference,
                                                const std::vector<double>& signal) const {
    const auto found = FindDelay(reference, signal, valid_, drive_.period);
    return found && std::abs(found->delay) > Uncertainty(*found) ? found : std::nullopt;
  }

  [[nodiscard]] double DelayInMap(LogSignal signal) const {
    return signal == kSpeedSignal     ? map_.speed->delay
           : signal == kYawRateSignal ? map_.yaw_rate->delay
                                      : map_.accelerometer->delay;
  }

  void CompareMotion(LogSignal signal, const std::vector<double>& reference);
  void CompareSteering(LogSignal signal);

  LogRows& rows_;
  const LogMap& map_;
  const RecordedDrive& drive_;
  double start_;
  std::vector<bool> valid_;
  std::vector<std::string> notes_;
};

std::vector<std::string> Clocks::Compare() {
  using S = RecordedSample;
  CompareMotion(kSpeedSignal, Of([](const S& s) { return s.velocity_V.x(); }));
  CompareMotion(kYawRateSignal, Of([](const S& s) { return s.yaw_rate; }));
  if (rows_.has[kAccelerationX]) {
    const Vec2 arm(map_.accelerometer->ahead, map_.accelerometer->left);
    const auto at_sensor = [&](const S& s) {
      return Vec2(s.acceleration_V - s.yaw_rate * s.yaw_rate * arm +
                  s.yaw_acceleration * LeftNormal(arm));
    };
    CompareMotion(kAccelerationX, Of([&](const S& s) { return at_sensor(s).x(); }));
    CompareMotion(kAccelerationY, Of([&](const S& s) { return at_sensor(s).y(); }));
  }
  CompareSteering(kSteeringSignal);
  CompareSteering(kSteeringCommandSignal);
  return std::move(notes_);
}

void Clocks::CompareMotion(LogSignal signal, const std::vector<double>& reference) {
  if (!rows_.has[signal]) {
    return;
  }
  LogSeries& series = rows_.signals[signal];
  const FittedSeries fits(series, map_);
  const auto found =
      Find(reference, Of([&](const RecordedSample& s) { return fits.At(LogTime(s))(0, 0); }));
  if (!found) {
    return;
  }
  const char* key = kLogSignalKeys[signal];
  const char* axis = signal == kAccelerationX ? ".x" : signal == kAccelerationY ? ".y" : "";
  const std::string what = fmt::format("{}{} {} the motion of the pose by {:.3g} s +- {:.2g} s",
                                       key, axis, found->delay > 0.0 ? "lags" : "precedes",
                                       std::abs(found->delay), Uncertainty(*found));
  if (map_.align) {
    for (double& time : series.time) {
      time -= found->delay;
    }
    notes_.push_back(what + ": shifted by this delay");
  } else {
    notes_.push_back(fmt::format("{}: shift it with --align, or set {}.delay: {:.3g} in the map",
                                 what, key, DelayInMap(signal) + found->delay));
  }
}

void Clocks::CompareSteering(LogSignal signal) {
  if (!rows_.has[signal]) {
    return;
  }
  const FittedSeries fits(rows_.signals[signal], map_);
  // The yaw rate is nearly proportional to the speed times the tangent of the steering angle.
  const std::vector<double> turning = Of([&](const RecordedSample& s) {
    return s.velocity_V.x() * std::tan(fits.At(LogTime(s))(0, 0));
  });
  const auto found = Find(turning, Of([](const RecordedSample& s) { return s.yaw_rate; }));
  if (found) {
    notes_.push_back(fmt::format(
        "the yaw rate {} {} by {:.3g} s +- {:.2g} s{}", found->delay > 0.0 ? "follows" : "precedes",
        kLogSignalKeys[signal], std::abs(found->delay), Uncertainty(*found),
        found->delay > 0.0
            ? "; the response of the car is a part of this delay"
            : ", which a car cannot do: the steering is logged late; set its delay"));
  }
}

}  // namespace

std::vector<std::string> CompareClocks(LogRows& rows, const LogMap& map, const RecordedDrive& drive,
                                       double start) {
  return Clocks(rows, map, drive, start).Compare();
}

}  // namespace trackbed

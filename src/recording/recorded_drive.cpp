#include "trackbed/recording/recorded_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Largest backward speed that counts as noise of a car at rest, not as driving in reverse [m/s].
constexpr double kBackwards = 0.05;

RecordedSample Between(const RecordedSample& a, const RecordedSample& b, double share) {
  const auto mix = [&](double RecordedSample::*value) {
    return std::lerp(a.*value, b.*value, share);
  };
  RecordedSample sample;
  sample.time = mix(&RecordedSample::time);
  sample.pose = {std::lerp(a.pose.x, b.pose.x, share), std::lerp(a.pose.y, b.pose.y, share),
                 std::lerp(a.pose.yaw, b.pose.yaw, share)};
  sample.velocity_V = a.velocity_V + share * (b.velocity_V - a.velocity_V);
  sample.yaw_rate = mix(&RecordedSample::yaw_rate);
  sample.acceleration_V = a.acceleration_V + share * (b.acceleration_V - a.acceleration_V);
  sample.yaw_acceleration = mix(&RecordedSample::yaw_acceleration);
  sample.steering = mix(&RecordedSample::steering);
  sample.steering_command = mix(&RecordedSample::steering_command);
  sample.throttle = mix(&RecordedSample::throttle);
  sample.valid = a.valid && b.valid;
  return sample;
}

/// Returns the names of the drive's signals that can be replayed, such as "steering_command,
/// throttle".
std::string SignalsOf(const RecordedDrive& drive) {
  std::string names;
  const auto add = [&](bool has, const char* name) {
    if (has) {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  };
  add(drive.has_steering, "steering");
  add(drive.has_steering_command, "steering_command");
  add(drive.has_throttle, "throttle");
  return names.empty() ? "none" : names;
}

void RequireSignal(const RecordedDrive& drive, bool has, const char* key, const char* name) {
  if (!has) {
    throw InputError(
        Problem{.key = key,
                .message = fmt::format("the recording '{}' has no {}; of steering, "
                                       "steering_command and throttle its map names: {}",
                                       drive.name, name, SignalsOf(drive))});
  }
}

void RequireForwards(const RecordedDrive& drive) {
  for (const RecordedSample& sample : drive.samples) {
    if (sample.valid && sample.velocity_V.x() < -kBackwards) {
      throw InputError(Problem{
          .key = "record.drive",
          .message = fmt::format("the recorded car goes backwards at {:.4g} s, at {:.3g} m/s; a "
                                 "replay drives forward only: cut it with record.from and "
                                 "record.to",
                                 sample.time, -sample.velocity_V.x())});
    }
  }
}

}  // namespace

double RecordedDrive::valid_fraction() const {
  const auto valid = std::count_if(samples.begin(), samples.end(),
                                   [](const RecordedSample& sample) { return sample.valid; });
  return static_cast<double>(valid) / static_cast<double>(samples.size());
}

RecordedSample RecordedDrive::At(double time) const {
  TRACKBED_REQUIRE(samples.size() >= 2 && period > 0.0,
                   "RecordedDrive::At: {} samples {} s apart; must be at least 2", samples.size(),
                   period);
  const double last = static_cast<double>(samples.size() - 1);
  const double place = std::clamp(time / period, 0.0, last);
  // Return a recorded sample without interpolation if its time differs from the requested time only
  // by rounding errors.
  constexpr double kRounding = 1e-6;
  const double nearest = std::round(place);
  if (std::abs(place - nearest) < kRounding) {
    return samples[static_cast<std::size_t>(nearest)];
  }
  const auto before = static_cast<std::size_t>(place);
  return Between(samples[before], samples[before + 1], place - static_cast<double>(before));
}

VehicleState StateOf(const RecordedSample& sample, const VehicleParams& vehicle, bool measured) {
  const double l = vehicle.cg_to_rear;
  const double r = sample.yaw_rate;
  VehicleState state;
  state.time = sample.time;
  state.pose = sample.pose;
  state.speed = sample.velocity_V.x();
  state.lateral_speed = sample.velocity_V.y() + l * r;
  state.yaw_rate = r;
  state.longitudinal_acceleration = sample.acceleration_V.x() - l * r * r;
  state.lateral_acceleration = sample.acceleration_V.y() + l * sample.yaw_acceleration;
  const double cg_speed = std::hypot(state.speed, state.lateral_speed);
  state.sideslip = cg_speed < kAtRestSpeed ? 0.0 : std::atan(state.lateral_speed / state.speed);
  state.steering = measured ? sample.steering : sample.steering_command;
  state.steering_actuator = state.steering;
  return state;
}

StartState StartFrom(const RecordedSample& sample, double steering) {
  constexpr double kMinSpeed = 0.2;  // [m/s]
  StartState start{
      .pose = sample.pose, .speed = std::max(0.0, sample.velocity_V.x()), .steering = steering};
  if (start.speed >= kMinSpeed) {
    start.lateral_speed = sample.velocity_V.y();
    start.yaw_rate = sample.yaw_rate;
  }
  return start;
}

Recording ReplayInputs(const RecordedDrive& drive, ReplaySteering steering, ReplayDrive source) {
  const bool measured = steering == ReplaySteering::kMeasured;
  if (measured) {
    RequireSignal(drive, drive.has_steering, "record.steering", "measured steering angle");
  } else {
    RequireSignal(drive, drive.has_steering_command, "record.steering", "steering command");
  }
  Recording inputs{.steering = {}, .speed = {}, .acceleration = {}};
  if (source == ReplayDrive::kSpeed) {
    RequireForwards(drive);
  } else {
    RequireSignal(drive, drive.has_throttle, "record.drive", "throttle");
  }
  for (const RecordedSample& sample : drive.samples) {
    inputs.steering.knots.emplace_back(sample.time,
                                       measured ? sample.steering : sample.steering_command);
    if (source == ReplayDrive::kSpeed) {
      inputs.speed.knots.emplace_back(sample.time, std::max(0.0, sample.velocity_V.x()));
    } else {
      inputs.acceleration.knots.emplace_back(sample.time, sample.throttle);
    }
  }
  return inputs;
}

}  // namespace trackbed

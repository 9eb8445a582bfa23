#include "trackbed/control/steering_controller.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "src/control/optimal_steering_controller.h"
#include "src/control/return_distance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

class ScheduleController final : public SteeringController {
 public:
  explicit ScheduleController(const ScheduleOptions&) {}

  double Steer(const ControlInput& input) override {
    return input.schedule.At(input.station + std::abs(input.state.speed) * input.period);
  }
};

class PreviewController final : public SteeringController {
 public:
  explicit PreviewController(const PreviewOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const Vec2 foot = input.reference.path.At(input.station).pose.position();
    const double offset = (input.state.pose.position() - foot).norm();
    const double distance =
        std::max(options_.distance, ReturnDistance(input.vehicle, input.state.speed, offset));
    const double u = PreviewAngle(input.reference.path, input.state.pose, input.station, distance);
    const double gain = 2.0 * input.vehicle.wheelbase / distance;
    const double steering =
        options_.law == PreviewLaw::kLinear ? gain * u : std::atan(gain * std::sin(u));
    // Backwards, wheels to the right turn the motion to the left.
    return input.reference.path.At(input.station).direction * steering;
  }

 private:
  PreviewOptions options_;
};

/// Steers as a profile over time says.
template <typename Options>
class ProfileController final : public SteeringController {
 public:
  explicit ProfileController(const Options& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    return SteeringAt(options_, input.state.time + input.period);
  }

 private:
  Options options_;
};

class PlaybackController final : public SteeringController {
 public:
  explicit PlaybackController(const PlaybackOptions& options) : options_(options) {
    const Recording& recording = options.recording;
    TRACKBED_CHECK(!recording.steering.empty() && recording.steering.Rises() &&
                       recording.speed.Rises() && recording.acceleration.Rises(),
                   "a recording without steering, or whose rows do not rise");
    TRACKBED_CHECK(recording.speed.empty() || recording.acceleration.empty(),
                   "a recording of both speed and acceleration");
  }

  double Steer(const ControlInput& input) override {
    return PlaybackSteering(options_, Axis(input), input.state.speed, input.period);
  }

  std::optional<double> Accelerate(const ControlInput& input) override {
    return PlaybackAcceleration(options_, Axis(input), input.state.speed, input.speed_gain,
                                input.period);
  }

 private:
  /// A change of plan does not wind the recording back: by distance it is the car's, not the
  /// plan's.
  [[nodiscard]] double Axis(const ControlInput& input) const {
    return options_.by == PlaybackAxis::kTime ? input.state.time : input.state.distance;
  }

  PlaybackOptions options_;
};

std::unique_ptr<SteeringController> Make(const ScheduleOptions& options) {
  return std::make_unique<ScheduleController>(options);
}
std::unique_ptr<SteeringController> Make(const PreviewOptions& options) {
  return std::make_unique<PreviewController>(options);
}
std::unique_ptr<SteeringController> Make(const PlaybackOptions& options) {
  return std::make_unique<PlaybackController>(options);
}
std::unique_ptr<SteeringController> Make(const OptimalSteeringOptions& options) {
  return MakeOptimalSteering(options);
}
template <typename Profile>
std::unique_ptr<SteeringController> Make(const Profile& options) {
  return std::make_unique<ProfileController<Profile>>(options);
}

/// Station of the first point after `station` that is `distance` away from p.
double PreviewStation(const Path& path, const Vec2& p, double station, double distance) {
  const auto beyond = [&](double s) { return (path.At(s).pose.position() - p).norm() - distance; };
  if (beyond(station) >= 0.0) {
    return station + distance;
  }
  // The path cannot leave the circle sooner than a straight line would. An eighth of the distance
  // finds the first crossing of any path that bends on radii above it.
  const double stride = distance / 8.0;
  double inside = station;
  while (beyond(inside + stride) < 0.0) {
    inside += stride;
  }
  std::uintmax_t iterations = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      beyond, inside, inside + stride, boost::math::tools::eps_tolerance<double>(48), iterations);
  return 0.5 * (low + high);
}

}  // namespace

std::optional<double> SteeringController::Accelerate(const ControlInput&) {
  return std::nullopt;
}

std::vector<std::string> SteeringController::Columns() const {
  return {};
}

std::vector<double> SteeringController::Values() const {
  return {};
}

double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance) {
  const double s = PreviewStation(path, pose.position(), station, distance);
  // Backwards, the direction of motion is against the heading.
  const Vec2 to_point = path.At(station).direction * ToLocal(pose, path.At(s).pose.position());
  return std::atan2(to_point.y(), to_point.x());
}

const std::vector<ControllerEntry>& Controllers() {
  static const std::vector<ControllerEntry> table{
      {"schedule", "the plan's steering over the distance driven, open loop", ScheduleOptions{},
       StationSource::kOdometer, true},
      {"preview", "aims at the path's point at a preview distance (MacAdam, one point)",
       PreviewOptions{}, StationSource::kProjection, true},
      {"optimal_steering", "searches the angle that leads nearest to the path's pose ahead",
       OptimalSteeringOptions{}, StationSource::kProjection, true},
      {"constant_steering", "holds one steering angle", ConstantSteeringOptions{},
       StationSource::kOdometer, false},
      {"step", "turns the wheels once, at a rate, and holds them (ISO 7401)", StepSteeringOptions{},
       StationSource::kOdometer, false},
      {"ramp", "turns the wheels slowly to an angle (SAE J266, ISO 4138)", RampSteeringOptions{},
       StationSource::kOdometer, false},
      {"sine", "sine steering for a number of cycles", SineSteeringOptions{},
       StationSource::kOdometer, false},
      {"sine_with_dwell", "one sine that stays at its second peak (ISO 19365)",
       SineWithDwellOptions{}, StationSource::kOdometer, false},
      {"swept_sine", "sine steering from one frequency to another", SweptSineOptions{},
       StationSource::kOdometer, false},
      {"playback", "replays recorded steering and speed or acceleration", PlaybackOptions{},
       StationSource::kOdometer, false},
  };
  return table;
}

const ControllerEntry& ControllerFor(const ControllerOptions& options) {
  for (const ControllerEntry& entry : Controllers()) {
    if (entry.defaults.index() == options.index()) {
      return entry;
    }
  }
  throw InternalError("options of a controller that is not in the table");
}

std::unique_ptr<SteeringController> MakeSteeringController(const ControllerOptions& options) {
  return std::visit([](const auto& own) { return Make(own); }, options);
}

}  // namespace trackbed

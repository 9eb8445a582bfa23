#include "trackbed/control/steering_controller.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "src/control/optimal_steering_controller.h"
#include "src/control/preview_distance.h"
#include "src/control/tracking.h"
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

/// The angle from where the rear axle points to where it moves [rad], left positive; 0 at a crawl.
double RearSlip(const ControlInput& input) {
  const VehicleState& state = input.state;
  const double across = state.lateral_speed - input.vehicle.cg_to_rear * state.yaw_rate;
  return std::abs(state.speed) < kCrawl ? 0.0 : std::atan(across / state.speed);
}

class PreviewController final : public SteeringController {
 public:
  explicit PreviewController(const PreviewOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const double shortest = options_.distance ? *options_.distance : PreviewDistance(input);
    const double distance =
        std::max({shortest, options_.time * std::abs(input.state.speed), ReturnDistance(input)});
    const int direction = input.reference.path.At(input.station).direction;
    const double u = PreviewAngle(input.reference.path, input.state.pose, input.station, distance) -
                     (options_.slip ? RearSlip(input) : 0.0);
    // Backwards, wheels to the right turn the motion to the left.
    const double bend =
        direction * 2.0 / distance * (options_.law == PreviewLaw::kLinear ? u : std::sin(u));
    return std::clamp(SteeringOn(input, bend, direction), -input.vehicle.steering_limit,
                      input.vehicle.steering_limit);
  }

 private:
  /// delta [rad] for a bend of `curvature`.
  [[nodiscard]] double SteeringOn(const ControlInput& input, double curvature,
                                  int direction) const {
    if (options_.slip) {
      const double speed = direction * std::abs(input.state.speed);
      return SteadyTurnOn(input.vehicle, curvature, speed).steering;
    }
    return options_.law == PreviewLaw::kLinear ? input.vehicle.wheelbase * curvature
                                               : SteeringForCurvature(input.vehicle, curvature);
  }

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
std::unique_ptr<SteeringController> Make(const PreviewIntegralOptions& options) {
  return MakePreviewIntegral(options);
}
std::unique_ptr<SteeringController> Make(const PurePursuitOptions& options) {
  return MakePurePursuit(options);
}
std::unique_ptr<SteeringController> Make(const StanleyOptions& options) {
  return MakeStanley(options);
}
std::unique_ptr<SteeringController> Make(const LqrOptions& options) {
  return MakeLqr(options);
}
std::unique_ptr<SteeringController> Make(const MpcOptions& options) {
  return MakeMpc(options);
}
template <typename Profile>
std::unique_ptr<SteeringController> Make(const Profile& options) {
  return std::make_unique<ProfileController<Profile>>(options);
}

/// Refuses what is no state before a controller makes an angle of it.
class Guarded final : public SteeringController {
 public:
  explicit Guarded(std::unique_ptr<SteeringController> inner) : inner_(std::move(inner)) {}

  double Steer(const ControlInput& input) override {
    Check(input);
    return inner_->Steer(input);
  }

  std::optional<double> Accelerate(const ControlInput& input) override {
    Check(input);
    return inner_->Accelerate(input);
  }

  [[nodiscard]] std::vector<std::string> Columns() const override { return inner_->Columns(); }

  [[nodiscard]] std::vector<double> Values() const override { return inner_->Values(); }

 private:
  static void Check(const ControlInput& input) {
    const VehicleState& state = input.state;
    for (const double number :
         {state.time, state.pose.x, state.pose.y, state.pose.yaw, state.speed, state.distance,
          state.lateral_speed, state.yaw_rate, state.steering_actuator, state.steering,
          input.station, input.plan_time, input.speed_gain}) {
      TRACKBED_CHECK(
          std::isfinite(number),
          "the car's state at {} s is not finite: x {}, y {}, yaw {}, speed {}, distance "
          "{}, lateral speed {}, yaw rate {}, steering {} and {}, station {}",
          state.time, state.pose.x, state.pose.y, state.pose.yaw, state.speed, state.distance,
          state.lateral_speed, state.yaw_rate, state.steering_actuator, state.steering,
          input.station);
    }
    TRACKBED_CHECK(input.period > 0.0 && std::isfinite(input.period), "a control period of {} s",
                   input.period);
  }

  std::unique_ptr<SteeringController> inner_;
};

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
      {"preview_integral", "the steering that, held, fits the previewed way best (MacAdam)",
       PreviewIntegralOptions{}, StationSource::kProjection, true},
      {"optimal_steering", "searches the angle that leads nearest to the path's pose ahead",
       OptimalSteeringOptions{}, StationSource::kProjection, true},
      {"pure_pursuit", "the circle through the path's point at a lookahead distance",
       PurePursuitOptions{}, StationSource::kProjection, true},
      {"stanley", "heading error and the front axle's offset (Stanley)", StanleyOptions{},
       StationSource::kProjection, true},
      {"lqr", "linear-quadratic regulator with preview of the path's curvature", LqrOptions{},
       StationSource::kProjection, true},
      {"mpc", "the same cost within the car's steering angle and rate, predicted ahead",
       MpcOptions{}, StationSource::kProjection, true},
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
  return std::make_unique<Guarded>(std::visit([](const auto& own) { return Make(own); }, options));
}

}  // namespace trackbed

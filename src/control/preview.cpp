#include "trackbed/control/preview.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/control/control_keys.h"
#include "src/control/preview_angle.h"
#include "src/control/preview_distance.h"
#include "src/control/timely_steering.h"
#include "src/control/turn_round.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

class Preview final : public SteeringController {
 public:
  explicit Preview(const PreviewOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const VehicleParams& vehicle = input.vehicle;
    const double speed = std::abs(input.state.speed);
    const double shortest =
        options_.distance.value_or(ShortestPreview(vehicle, input.state.speed, input.period));
    const double least = std::max(shortest, options_.time * speed);
    if (options_.distance) {
      path_.UpdateWithoutRamps(input);
    } else {
      // In a turn of up to 200 degrees, a preview point at the distance R from the car is less than
      // 2 R farther along the path.
      path_.Update(input, std::max(TimelySteering::Horizon(input),
                                   2.0 * std::max(least, ReturnDistance(input))));
    }
    const Tracking tracking = path_.Track();
    const double distance = std::max(least, ReturnDistance(vehicle, speed, tracking.cross_track));
    const int direction = tracking.foot.direction;
    const Pose2& pose = input.state.pose;
    const double angle = AngleTo(path_, direction, pose, input.station, distance);
    if (const std::optional<double> steering = turn_round_.Steer(input, angle)) {
      return *steering;
    }
    const bool slip = options_.slip && HasTyres(vehicle);
    const double slip_angle = slip ? SteadyHeading(input, direction) : 0.0;
    const Vec2 to_left(-std::sin(tracking.foot.pose.yaw), std::cos(tracking.foot.pose.yaw));
    const auto bend_toward = [&](double u) {
      // In reverse gear, steering to the right turns the direction of motion to the left.
      return direction * 2.0 / distance * (options_.law == PreviewLaw::kLinear ? u : std::sin(u));
    };
    // Where the curvature changes, the circle to the preview point differs from the path. The
    // difference for a car on its path is not an error, so the law leaves it out.
    const double correction = options_.distance
                                  ? 0.0
                                  : path_.CurvatureAfter(ResponseDistance(input)) -
                                        bend_toward(AngleTo(path_, direction, tracking.foot.pose,
                                                            input.station, distance));
    const auto toward = [&](double angle_to_point) {
      const double bend = bend_toward(angle_to_point + slip_angle) + correction;
      const double limit = vehicle.steering_limit;
      return std::clamp(SteeringOn(input, bend, direction), -limit, limit);
    };
    if (options_.distance) {
      return toward(angle);
    }
    const auto law = [&](const GainedErrors& gained) {
      const Vec2 position = pose.position() + gained.cross_track * to_left;
      const Pose2 later{position.x(), position.y(), pose.yaw + gained.heading};
      return toward(AngleTo(path_, direction, later, input.station, distance));
    };
    return timely_.Steer(input, path_, slip, toward(angle), std::cref(law));
  }

 private:
  /// Returns the heading error [rad] of the car in the steady turn on its path. The curvature of
  /// the steady turn is the path's mean curvature over the next wheelbase, so that a short flaw of
  /// the path does not move the wheels.
  [[nodiscard]] double SteadyHeading(const ControlInput& input, int direction) const {
    const double ahead = input.vehicle.wheelbase;
    const double turned =
        AngleDifference(path_.At(input.station + ahead).pose.yaw, path_.At(input.station).pose.yaw);
    const double speed = direction * std::abs(input.state.speed);
    // The heading error that SteadyTurnOn returns is the ratio of lateral to longitudinal speed,
    // not an angle.
    return std::atan(
        SteadyTurnOn(input.vehicle, turned / (direction * ahead), speed).heading_error);
  }

  /// Returns the steering angle delta [rad] for a given curvature of the car's path.
  [[nodiscard]] double SteeringOn(const ControlInput& input, double curvature,
                                  int direction) const {
    const double speed = direction * std::abs(input.state.speed);
    const SteadyTurn turn = options_.slip ? SteadyTurnOn(input.vehicle, curvature, speed)
                                          : TurnWithoutSlip(input.vehicle, curvature, speed);
    return options_.law == PreviewLaw::kLinear ? std::tan(turn.steering) : turn.steering;
  }

  PreviewOptions options_;
  RampedPath path_;
  TimelySteering timely_;
  TurnRound turn_round_;
};

}  // namespace

double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance) {
  TRACKBED_REQUIRE(distance > 0.0 && std::isfinite(distance) && std::isfinite(station),
                   "PreviewAngle: {} m ahead of station {} m; must be finite, ahead", distance,
                   station);
  return AngleTo(path, path.BendAt(station).direction, pose, station, distance);
}

void Visit(KeyVisitor& keys, PreviewOptions& options) {
  keys.Field({"distance", "m",
              "minimum lookahead distance ahead of the rear axle; default: from car and speed"},
             options.distance, kAhead);
  keys.Field(kAheadTime, options.time, Need::kOptional, kNonNegative);
  static const EnumNames<PreviewLaw> laws{{PreviewLaw::kLinear, "linear"},
                                          {PreviewLaw::kExactArc, "exact_arc"}};
  keys.Field({"law", "",
              "steering law: MacAdam's gain on the angle to the preview point, or the arc through "
              "the point"},
             options.law, Need::kOptional, laws);
  keys.Field({"slip", "", "whether to account for tyre slip"}, options.slip, Need::kOptional);
}

ControllerEntry PreviewController() {
  return {.name = "preview",
          .summary = "steers to the path point at a preview distance (MacAdam, one point)",
          .defaults = PreviewOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<PreviewOptions, Preview>};
}

}  // namespace trackbed

#include "trackbed/control/pure_pursuit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/control/control_keys.h"
#include "src/control/preview_distance.h"
#include "src/control/timely_steering.h"
#include "src/control/turn_round.h"
#include "trackbed/control/preview.h"

namespace trackbed {
namespace {

class PurePursuit final : public SteeringController {
 public:
  explicit PurePursuit(const PurePursuitOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const Path& path = input.reference.path;
    const double shortest = options_.distance ? *options_.distance : Lookahead(input);
    const double distance = std::max(shortest, options_.time * std::abs(input.state.speed));
    const double u = PreviewAngle(path, input.state.pose, input.station, distance);
    if (const std::optional<double> steering = turn_round_.Steer(input, u)) {
      return *steering;
    }
    const int direction = path.BendAt(input.station).direction;
    const auto toward = [&](double angle) {
      const double steering = std::atan(2.0 * input.vehicle.wheelbase * std::sin(angle) / distance);
      const double limit = input.vehicle.steering_limit;
      // In reverse gear, steering to the right turns the direction of motion to the left.
      return direction * std::clamp(steering, -limit, limit);
    };
    if (options_.distance) {
      return toward(u);
    }
    path_.UpdateWithoutRamps(input);
    const double yaw = path_.At(input.station).pose.yaw;
    const Vec2 to_left(-std::sin(yaw), std::cos(yaw));
    const auto law = [&](const GainedErrors& gained) {
      const Vec2 position = input.state.pose.position() + gained.cross_track * to_left;
      const Pose2 later{position.x(), position.y(), input.state.pose.yaw + gained.heading};
      return toward(PreviewAngle(path, later, input.station, distance));
    };
    return timely_.Steer(input, path_, false, toward(u), std::cref(law));
  }

 private:
  double Lookahead(const ControlInput& input) {
    const double design = kReturnOffset * input.vehicle.wheelbase;
    return std::max({planned_.Next(input), ReturnDistance(input),
                     ReturnDistance(input.vehicle, input.state.speed, design)});
  }

  PurePursuitOptions options_;
  HeldPreviewDistance planned_;
  RampedPath path_;
  TimelySteering timely_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry PurePursuitController() {
  return {.name = "pure_pursuit",
          .summary = "arc through the path point at the lookahead distance (pure pursuit)",
          .defaults = PurePursuitOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<PurePursuitOptions, PurePursuit>};
}

void Visit(KeyVisitor& keys, PurePursuitOptions& options) {
  keys.Field(
      {"distance", "m",
       "minimum lookahead distance ahead of the rear axle; default: from car, speed and path"},
      options.distance, kAhead);
  keys.Field(kAheadTime, options.time, Need::kOptional, kNonNegative);
}

}  // namespace trackbed

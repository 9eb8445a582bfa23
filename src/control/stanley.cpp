#include "trackbed/control/stanley.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/control/preview_distance.h"
#include "src/control/ramped_path.h"
#include "src/control/timely_steering.h"
#include "src/control/turn_round.h"

namespace trackbed {
namespace {

/// Least ratio of the law's lever D to the distance v T that the car drives in its response time T.
/// With D = 3 v T and the offset gain 1/(6 v T), a kinematic car with the steering lag T has the
/// characteristic polynomial x^3/3 + x^2 + 3/2 x + 1/2 in x = s D/v. The damping ratio is 0.7.
constexpr double kResponses = 3.0;

class Stanley final : public SteeringController {
 public:
  explicit Stanley(const StanleyOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      return *steering;
    }
    const VehicleParams& vehicle = input.vehicle;
    path_.Update(input, std::max(ResponseDistance(input), TimelySteering::Horizon(input)));
    const Tracking tracking = path_.Track();
    const int direction = tracking.foot.direction;
    const double speed = std::abs(input.state.speed);
    const SteadyTurn turn = SteadyTurnOn(vehicle, tracking.foot.curvature, direction * speed);
    const SteadyTurn ahead =
        SteadyTurnOn(vehicle, path_.CurvatureAfter(ResponseDistance(input)), direction * speed);
    const CarScale scale = ComputeCarScale(vehicle);
    const double gain = options_.gain.value_or(1.0 / scale.time);
    const double softening = options_.softening.value_or(scale.length / scale.time);
    const double response =
        options_.gain ? 0.0 : kResponses * speed * ResponseTime(vehicle, speed, input.period);
    const double lever = std::max(vehicle.wheelbase, response);
    const double divisor = std::max(softening + speed, 2.0 * gain * response);
    const auto law = [&](const GainedErrors& gained) {
      const double heading = tracking.heading_error - turn.heading_error + gained.heading;
      double offset = tracking.cross_track + gained.cross_track;
      if (direction > 0) {
        offset += lever * std::sin(heading);
      }
      // Use atan2, because without softening the divisor is 0 at rest; the steering angle is then
      // at its limit.
      const double approach = std::atan2(gain * offset, divisor);
      const double feedback = vehicle.wheelbase / lever * (direction * heading + approach);
      return std::clamp(ahead.steering - feedback, -vehicle.steering_limit, vehicle.steering_limit);
    };
    if (options_.gain) {
      return law({});
    }
    return timely_.Steer(input, path_, HasTyres(vehicle), law({}), std::cref(law));
  }

 private:
  StanleyOptions options_;
  RampedPath path_;
  TimelySteering timely_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry StanleyController() {
  return {.name = "stanley",
          .summary = "feedback of heading error and front-axle cross-track error (Stanley)",
          .defaults = StanleyOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<StanleyOptions, Stanley>};
}

void Visit(KeyVisitor& keys, StanleyOptions& options) {
  keys.Field(
      {"gain", "1/s", "gain on the front-axle cross-track error; default: from the steering rate"},
      options.gain, kPositive);
  keys.Field(
      {"softening", "m/s", "softening term added to the speed; default: from the car's size"},
      options.softening, kNonNegative);
}

}  // namespace trackbed

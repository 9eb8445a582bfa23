#include "trackbed/control/rear_axle_feedback.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/control/control_keys.h"
#include "src/control/preview_distance.h"
#include "src/control/ramped_path.h"
#include "src/control/timely_steering.h"
#include "src/control/turn_round.h"

namespace trackbed {
namespace {

/// Lower bound of the factor 1 - kappa e, which is zero at the path's center of curvature and makes
/// the control law singular.
constexpr double kNearCenter = 0.1;

double Sinc(double angle) {
  return std::abs(angle) < 1e-8 ? 1.0 : std::sin(angle) / angle;
}

double DefaultDistance(const ControlInput& input, double cross_track) {
  const double speed = input.state.speed;
  const double offset = std::max(std::abs(cross_track), kReturnOffset * input.vehicle.wheelbase);
  const double response = ResponseTime(input.vehicle, speed, input.period);
  return std::max(ReturnDistance(input.vehicle, speed, offset), 3.0 * std::abs(speed) * response);
}

class RearAxleFeedback final : public SteeringController {
 public:
  explicit RearAxleFeedback(const RearAxleFeedbackOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      return *steering;
    }
    const VehicleParams& vehicle = input.vehicle;
    path_.Update(input, std::max(ResponseDistance(input), TimelySteering::Horizon(input)));
    const Tracking tracking = path_.Track();
    const int direction = tracking.foot.direction;
    const double speed = direction * std::abs(input.state.speed);
    const double curvature = tracking.foot.curvature;
    const double steady_heading = SteadyTurnOn(vehicle, curvature, speed).heading_error;
    const double d =
        options_.distance ? *options_.distance : DefaultDistance(input, tracking.cross_track);
    const double later_curvature = path_.CurvatureAfter(ResponseDistance(input));
    const auto law = [&](const GainedErrors& gained) {
      const double e = tracking.cross_track + gained.cross_track;
      const double psi = tracking.heading_error - steady_heading + gained.heading;
      const double parallel =
          later_curvature * std::cos(psi) / std::max(1.0 - curvature * e, kNearCenter);
      const double feedback = direction * 2.0 * psi / d + e * Sinc(psi) / (d * d);
      const double steering = SteadyTurnOn(vehicle, parallel - feedback, speed).steering;
      return std::clamp(steering, -vehicle.steering_limit, vehicle.steering_limit);
    };
    if (options_.distance) {
      return law({});
    }
    return timely_.Steer(input, path_, HasTyres(vehicle), law({}), std::cref(law));
  }

 private:
  RearAxleFeedbackOptions options_;
  RampedPath path_;
  TimelySteering timely_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry RearAxleFeedbackController() {
  return {.name = "rear_axle_feedback",
          .summary = "Lyapunov feedback of the rear axle's heading and cross-track error",
          .defaults = RearAxleFeedbackOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<RearAxleFeedbackOptions, RearAxleFeedback>};
}

void Visit(KeyVisitor& keys, RearAxleFeedbackOptions& options) {
  keys.Field({"distance", "m",
              "distance over which errors decay by 1/e; default: from car, speed and offset"},
             options.distance, kAhead);
}

}  // namespace trackbed

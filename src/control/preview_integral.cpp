#include "trackbed/control/preview_integral.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "src/control/control_keys.h"
#include "src/control/preview_distance.h"
#include "src/control/tracking.h"
#include "src/control/turn_round.h"
#include "trackbed/control/preview.h"

namespace trackbed {
namespace {

/// Speed below which the controller uses the kinematic model of the car [m/s]. At 1 m/s, the
/// kinematic and the dynamic model differ by less than 1 %.
constexpr double kMinDynamicSpeed = 1.0;

/// Predicted lateral displacement of the car at a future time.
struct Responses {
  double free = 0.0;  ///< Lateral displacement y_0 that the car would have without steering [m].
  /// Lateral displacement A of the car caused by a unit step of the steering angle [m].
  double step = 0.0;
};

/// Returns the lateral displacements of the rear axle of a kinematic car after the distance `way`
/// [m].
Responses KinematicResponses(const ControlInput& input, double way) {
  return {.free = 0.0, .step = way * way / (2.0 * input.vehicle.wheelbase)};
}

/// Returns the lateral displacements of the linear single-track car after driving forward for
/// `time` [s]. The model's states (y, psi, v, r) are relative to the car's present frame.
Responses SingleTrackResponses(const ControlInput& input, double time) {
  const VehicleParams& vehicle = input.vehicle;
  const VehicleState& state = input.state;
  Eigen::Matrix<double, 5, 5> rates = Eigen::Matrix<double, 5, 5>::Zero();
  rates(0, 1) = state.speed;
  rates(0, 2) = 1.0;
  rates(0, 3) = -vehicle.cg_to_rear;
  rates(1, 3) = 1.0;
  rates.block<2, 3>(2, 2) = LateralRates(
      vehicle, {vehicle.cornering_stiffness_front, vehicle.cornering_stiffness_rear}, state.speed);
  const Eigen::Matrix<double, 5, 5> scaled = rates * time;
  const Eigen::Matrix<double, 5, 5> after = scaled.exp();
  return {.free = after(0, 2) * state.lateral_speed + after(0, 3) * state.yaw_rate,
          .step = after(0, 4)};
}

class PreviewIntegral final : public SteeringController {
 public:
  explicit PreviewIntegral(const PreviewIntegralOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const VehicleParams& vehicle = input.vehicle;
    const Path& path = input.reference.path;
    const int direction = path.BendAt(input.station).direction;
    const double speed = std::abs(input.state.speed);
    const double spread = std::sqrt(OffsetGain());
    const double shortest =
        options_.distance ? *options_.distance : spread * PreviewDistance(input, options_.delay);
    const double distance =
        std::max({shortest, options_.time * speed, spread * ReturnDistance(input)});
    if (const std::optional<double> steering = turn_round_.Steer(input, distance)) {
      return Delayed(*steering, input);
    }
    const bool dynamic =
        direction > 0 && input.state.speed >= kMinDynamicSpeed && HasTyres(vehicle);

    using Gauss = boost::math::quadrature::gauss<double, 10>;
    double moved = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        const double share = 0.5 * (1.0 + side * Gauss::abscissa()[i]);
        const double way = share * distance;
        const Responses responses =
            dynamic ? SingleTrackResponses(input, way / speed) : KinematicResponses(input, way);
        const double importance =
            Gauss::weights()[i] * (options_.weight == PreviewWeight::kNear ? 1.0 - share : 1.0);
        const double across =
            way * std::sin(PreviewAngle(path, input.state.pose, input.station, way));
        moved += importance * (across - responses.free) * responses.step;
        square += importance * responses.step * responses.step;
      }
    }
    // In reverse gear, steering to the right turns the direction of motion to the left.
    const double wanted = direction * std::atan(moved / square);
    return Delayed(std::clamp(wanted, -vehicle.steering_limit, vehicle.steering_limit), input);
  }

 private:
  /// Returns the ratio of this law's gain on a lateral offset to the gain of the single-point law
  /// with the same preview distance. For the kinematic car, the gain is R^2/2 times the ratio of
  /// the integrals of A W and A^2 W. For equal damping, the preview distance must be proportional
  /// to the square root of the gain ratio.
  [[nodiscard]] double OffsetGain() const {
    return options_.weight == PreviewWeight::kNear ? 5.0 / 2.0 : 5.0 / 3.0;
  }

  /// Returns the steering angle that the control law computed one delay time earlier. During the
  /// first delay after the start, returns the initial wheel angle.
  double Delayed(double wanted, const ControlInput& input) {
    const double periods = options_.delay / input.period;
    const auto whole = static_cast<std::size_t>(periods);
    if (past_commands_.empty()) {
      past_commands_.assign(whole + 2, input.state.steering_actuator);
    }
    std::rotate(past_commands_.begin(), past_commands_.end() - 1, past_commands_.end());
    past_commands_.front() = wanted;
    return std::lerp(past_commands_[whole], past_commands_[whole + 1],
                     periods - static_cast<double>(whole));
  }

  PreviewIntegralOptions options_;
  TurnRound turn_round_;
  std::vector<double> past_commands_;  // past steering angles of the law, the newest first
};

}  // namespace

ControllerEntry PreviewIntegralController() {
  return {.name = "preview_integral",
          .summary = "the constant steering angle that fits the previewed path best (MacAdam)",
          .defaults = PreviewIntegralOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<PreviewIntegralOptions, PreviewIntegral>};
}

void Visit(KeyVisitor& keys, PreviewIntegralOptions& options) {
  keys.Field({"distance", "m",
              "minimum preview distance ahead of the rear axle; default: from car, speed and path"},
             options.distance, kAhead);
  keys.Field(kAheadTime, options.time, Need::kOptional, kNonNegative);
  static const EnumNames<PreviewWeight> weights{{PreviewWeight::kUniform, "uniform"},
                                                {PreviewWeight::kNear, "near"}};
  keys.Field(
      {"weight", "", "weighting of the previewed path: uniform, or decreasing with distance"},
      options.weight, Need::kOptional, weights);
  keys.Field({"delay", "s", "driver delay before the steering command takes effect"}, options.delay,
             Need::kOptional, Range{.min = 0.0, .max = 2.0});
}

}  // namespace trackbed

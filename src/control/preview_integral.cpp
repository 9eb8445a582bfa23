#include "trackbed/control/preview_integral.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "src/control/control_keys.h"
#include "src/control/preview_angle.h"
#include "src/control/preview_distance.h"
#include "src/control/timely_steering.h"
#include "src/control/tracking.h"
#include "src/control/turn_round.h"

// MacAdam's optimal preview control (MacAdam 1981):
//   1. Choose the preview distance R at which MacAdam's law and the single-point preview law have
//      equal gains.
//   2. At ten Gauss nodes within R, compute the car's free motion y_0 and its response A to a unit
//      step of the steering. Use the linear single-track model, or the kinematic model if the tyres
//      are unknown.
//   3. Steer by the angle that minimizes the weighted integral of the squared distance from the
//      path: int (f - y_0) A W / int A^2 W, with the lateral displacement f of the path and the
//      weight W.
//   4. Reduce the steering angle until the wheels can turn back in time (TimelySteering). Finally,
//      apply the configured delay to the steering angle.
namespace trackbed {
namespace {

/// Predicted lateral displacement of the car, without steering and due to steering.
struct Responses {
  double free = 0.0;  ///< Lateral displacement y_0 that the car would have without steering [m].
  /// Lateral displacement A of the car caused by a steering angle step of 1 rad [m/rad].
  double step = 0.0;
};

/// Returns the lateral displacements of the rear axle of a kinematic car after the distance `way`
/// [m].
Responses KinematicResponses(const ControlInput& input, double way) {
  return {.free = 0.0, .step = way * way / (2.0 * input.vehicle.wheelbase)};
}

/// Returns the lateral displacements of the linear single-track car after driving forward for
/// `time` [s]. The states (y, psi, v, r) of the single-track model are lateral displacement,
/// heading, lateral speed and yaw rate, relative to the car's present pose.
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
    const int direction = input.reference.path.BendAt(input.station).direction;
    UpdatePath(input, TimelySteering::Horizon(input));
    const Tracking tracking = path_.Track();
    const double distance = Distance(input, direction, tracking.cross_track);
    // In a turn of up to 200 degrees, a point at the distance R from the car is less than 2 R
    // farther along the path.
    UpdatePath(input, std::max(TimelySteering::Horizon(input), 2.0 * distance));
    const Pose2& pose = input.state.pose;
    const double angle = AngleTo(path_, direction, pose, input.station, distance);
    if (const std::optional<double> steering = turn_round_.Steer(input, angle)) {
      return Delayed(*steering, input);
    }
    const std::array<Node, 10> nodes = Nodes(input, direction, distance);
    std::array<Vec2, 10> points;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double s = PreviewStation(path_, pose.position(), input.station, nodes[i].way);
      points[i] = path_.At(s).pose.position();
    }
    const Vec2 to_left(-std::sin(tracking.foot.pose.yaw), std::cos(tracking.foot.pose.yaw));
    const auto law = [&](const GainedErrors& gained) {
      const Vec2 position = pose.position() + gained.cross_track * to_left;
      return SteerToward(input, direction, nodes, points,
                         {position.x(), position.y(), pose.yaw + gained.heading});
    };
    const double untimely = law({});
    if (options_.distance) {
      return Delayed(untimely, input);
    }
    const bool slip = HasTyres(input.vehicle);
    return Delayed(timely_.Steer(input, path_, slip, untimely, std::cref(law)), input);
  }

 private:
  /// A node of the quadrature over the previewed path.
  struct Node {
    double way = 0.0;     // Distance from the car along its motion [m].
    double weight = 0.0;  // Weight of the quadrature times the weight W of the previewed point.
    Responses responses;
  };
  using Gauss = boost::math::quadrature::gauss<double, 10>;

  /// Returns the quadrature nodes over the preview distance. The car's lateral responses at the
  /// quadrature nodes are computed by the car model for the present speed.
  [[nodiscard]] std::array<Node, 10> Nodes(const ControlInput& input, int direction,
                                           double distance) const {
    const bool dynamic = IsDynamic(input, direction);
    std::array<Node, 10> nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      const double share = 0.5 * (1.0 + side * Gauss::abscissa()[i / 2]);
      const double way = share * distance;
      nodes[i] = {
          way,
          Gauss::weights()[i / 2] * (options_.weight == PreviewWeight::kNear ? 1.0 - share : 1.0),
          dynamic ? SingleTrackResponses(input, way / std::abs(input.state.speed))
                  : KinematicResponses(input, way)};
    }
    return nodes;
  }

  [[nodiscard]] static bool IsDynamic(const ControlInput& input, int direction) {
    return direction > 0 && input.state.speed >= kMinDynamicSpeed && HasTyres(input.vehicle);
  }

  /// Updates the ramped path up to `ahead` [m] ahead of the car. If the options set a preview
  /// distance, the path is used without curvature ramps.
  void UpdatePath(const ControlInput& input, double ahead) {
    if (options_.distance) {
      path_.UpdateWithoutRamps(input);
    } else {
      path_.Update(input, ahead);
    }
  }

  /// Returns the steering angle [rad] with which a car at `pose` fits the previewed `points` best.
  static double SteerToward(const ControlInput& input, int direction,
                            const std::array<Node, 10>& nodes, const std::array<Vec2, 10>& points,
                            const Pose2& pose) {
    double moved = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto& [way, weight, responses] = nodes[i];
      // In reverse, the direction of motion is opposite to the heading.
      const Vec2 to_point = direction * ToLocal(pose, points[i]);
      const double across = way * std::sin(std::atan2(to_point.y(), to_point.x()));
      moved += weight * (across - responses.free) * responses.step;
      square += weight * responses.step * responses.step;
    }
    const double limit = input.vehicle.steering_limit;
    // In reverse gear, steering to the right turns the direction of motion to the left.
    return std::clamp(direction * std::atan(moved / square), -limit, limit);
  }

  /// Returns the preview distance R [m] of MacAdam's law.
  double Distance(const ControlInput& input, int direction, double cross_track) {
    const double speed = input.state.speed;
    const double single = std::max(
        options_.distance ? 0.0
                          : ShortestPreview(input.vehicle, speed, input.period, options_.delay),
        ReturnDistance(input.vehicle, speed, cross_track));
    return std::max({options_.distance.value_or(0.0), options_.time * std::abs(input.state.speed),
                     DistanceOfEqualGain(input, direction, single)});
  }

  /// Returns the preview distance R [m] at which MacAdam's law and the single-point preview law
  /// respond to an offset with equal gains. The single-point law has the preview distance R_1 =
  /// `single`. The gain of the single-point law with the preview distance R_1 is 2 L'/R_1^2, where
  /// L' is the ratio of steering angle to curvature in a steady turn. For the kinematic car, L' is
  /// the wheelbase. For the kinematic car, the ratio R/R_1 of preview distances is the square root
  /// of KinematicGainRatio. Because tyres respond late, the step response A is smaller than for the
  /// kinematic car. The gain int A W/int A^2 W, with the weight W, is then larger. A car with tyres
  /// needs a longer preview distance R. With the kinematic car's R, a car with a limited steering
  /// rate would oscillate about its path forever.
  [[nodiscard]] double DistanceOfEqualGain(const ControlInput& input, int direction,
                                           double single) const {
    double distance = std::sqrt(KinematicGainRatio()) * single;
    // The law's gain is nearly proportional to R^-2.5, with the preview distance R, so each
    // iteration divides the error of R by -4.
    constexpr int kIterations = 5;
    constexpr double kTolerance = 0.01;
    constexpr double kGentle = 1e-6;  // [1/m]
    const double length =
        std::max(SteadyTurnOn(input.vehicle, kGentle, input.state.speed).steering / kGentle,
                 input.vehicle.wheelbase);
    for (int i = 0; i < kIterations && IsDynamic(input, direction); ++i) {
      double moved = 0.0;
      double square = 0.0;
      for (const Node& node : Nodes(input, direction, distance)) {
        moved += node.weight * node.responses.step;
        square += node.weight * node.responses.step * node.responses.step;
      }
      const double ratio = moved / square * single * single / (2.0 * length);
      distance *= std::sqrt(ratio);
      if (std::abs(ratio - 1.0) < kTolerance) {
        break;
      }
    }
    return distance;
  }

  /// Returns the ratio of the gains of MacAdam's law and the single-point law on a lateral offset,
  /// for a kinematic car and equal preview distances R. The gain ratio is R^2/2 times the integral
  /// of A W divided by the integral of A^2 W, with the step response A and the weight W.
  [[nodiscard]] double KinematicGainRatio() const {
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
  RampedPath path_;
  TimelySteering timely_;
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
              "minimum preview distance ahead of the rear axle; default: from car and speed"},
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

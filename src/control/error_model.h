#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "src/control/tracking.h"

namespace trackbed {

class RampedPath;

/// Linear discrete-time model of a car's deviation from its path at constant speed u; the steering
/// rate is constant in each time step. LQR and MPC are based on this model.
///
/// The error model's state x consists of the car's offset e from the path [m], heading error psi
/// [rad], actuator angle delta and road wheel angle delta_w. For a car with tyre coefficients, the
/// state x also contains the lateral speed v and the yaw rate r at the center of gravity. The angle
/// of the road wheels follows the actuator's angle with the car's steering lag.
///
/// The error dynamics follow Rajamani 2012, ch. 2, except that e is the offset of the rear axle: e'
/// = u psi + v - l_r r and psi' = r - u kappa. In these equations, l_r is the distance from the
/// rear axle to the center of gravity. The linear model is
///   x' = A x + B w + D kappa + C c.
/// The input w = delta' is the steering rate, and kappa is the path's curvature. The constant c =
/// tan(delta_0) - delta_0 is the linearization error of the tangent in the steady turn with the
/// steering angle delta_0. The lateral motion depends on the tangent of the wheel angle, which the
/// model approximates by a line of slope 1 through the value at delta_0. In the model, a car in a
/// steady turn therefore stays on its path, at any curvature.
struct ErrorModel {
  static constexpr int kMaxStates = 6;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  /// Signed speed u for which the model is linearized [m/s], never close to 0.
  double speed = 0.0;
  double period = 0.0;  ///< Duration of a time step of the model [s].
  TyreForces tyres = TyreForces::kLinear;
  /// Matrix a of the discrete-time model: the state after a step is a x + b w + d kappa + c
  /// (tan(delta_0) - delta_0), with the state x and the steering rate w.
  Matrix a;
  Vector b;
  Vector d;
  Vector c;
};

/// Makes the error model for the car's present speed. The sign of the model's speed is the path's
/// direction of motion at the point nearest to the car. The magnitude of the model's speed is at
/// least the smaller of 2.46 L omega and 1 m/s, even if the car rolls against the direction of
/// motion.
///
/// With kBrush, the cornering stiffnesses C_f and C_r are evaluated for the turn at the path point
/// nearest to the car and for the planned acceleration. With kBrush, the steady turn is not a fixed
/// point of the linear model. The matrix `a` nevertheless describes how deviations of the state x
/// from the steady turn evolve.
ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyres = TyreForces::kLinear);

/// Makes the error model for a motion, whose speed must be as in MakeErrorModel above.
ErrorModel MakeErrorModelFor(const VehicleParams& vehicle, const Motion& motion, double period,
                             TyreForces tyres);

/// Returns the error model's state x (offset, heading error, angles) for the car's present state.
ErrorModel::Vector ErrorState(const ControlInput& input, const Tracking& tracking,
                              TyreForces tyres = TyreForces::kLinear);

/// Integrates the commanded steering rate to the commanded steering angle. The integration of the
/// steering rate continues from the last commanded angle, not from the measured angle of the
/// actuator. If the integration started from the measured angle, an actuator with a delay, with
/// backlash or with a gain error of 10 % would never reach the wanted angle. Feedback compensates
/// the actuator's error, since the measured angle is part of the controller's state x.
class CommandedAngle {
 public:
  /// Returns the last commanded angle delta [rad]; before the first command, this is the actuator's
  /// angle.
  [[nodiscard]] double Now(const ControlInput& input) const;
  /// Returns the new commanded angle delta at the end of the control period [rad], clamped to the
  /// car's limit of the steering rate and to AllowedSteering (steering_limit.h).
  double Turn(const ControlInput& input, double rate);
  /// Turns toward `angle` [rad] as far as the steering rate allows in a control period, and returns
  /// the new commanded angle delta [rad].
  double Approach(const ControlInput& input, double angle);

 private:
  std::optional<double> last_;
};

/// Weights of the cost of LQR and MPC: of the offset e, the heading error psi minus its steady
/// value psi_0, and the steering rate w minus its steady value r. The cost is the sum over all
/// steps of
///   cross_track e^2 + heading (psi - psi_0)^2 + steering_rate (w - r)^2,
/// with the steering rate r of the steady turn on the path (Ahead::rate).
struct ErrorWeights {
  double cross_track = 1.0;  ///< Weight of the squared offset e^2 in the cost [1/m^2], > 0.
  double heading = 1.0;      ///< Weight of the squared heading error in the cost [1/rad^2], >= 0.
  /// Weight of the squared steering rate in the cost [s^2/rad^2], > 0.
  double steering_rate = 1.0;
};

/// Converts the options of LQR or MPC to weights. The default cost weights measure offsets relative
/// to the wheelbase, and steering rates relative to the car's maximum rate. Because the default
/// weights are scaled by the car's dimensions, they suit cars of any size.
template <typename Options>
ErrorWeights WeightsFor(const VehicleParams& vehicle, const Options& options) {
  const CarScale scale = ComputeCarScale(vehicle);
  return {.cross_track = options.cross_track.value_or(1.0 / (scale.length * scale.length)),
          .heading = options.heading,
          .steering_rate = options.steering_rate.value_or(scale.time * scale.time)};
}

/// Converts controller options to cost weights, for a car at `speed` u [m/s] with a steering lag
/// and the control period `period` T [s]. Without a heading weight, the closed loop of a car
/// without slip has the bandwidth w_0 = ((u^2/L)^2 cross_track/steering_rate)^(1/6). In the formula
/// of the bandwidth w_0, L is the wheelbase, and cross_track and steering_rate are the cost
/// weights. The default weight of the steering rate is increased until the closed loop's time
/// constant 1/w_0 is at least twice SteeringResponse::time_constant and kPeriods times T. With a
/// faster closed loop, the steering lag would turn small actuator errors, such as backlash, into
/// oscillations. In a loop faster than kPeriods control periods, the saturated steering rate would
/// change its sign from period to period.
template <typename Options>
ErrorWeights WeightsFor(const VehicleParams& vehicle, const Options& options, double speed,
                        double period) {
  constexpr double kLags = 2.0;     // Lower bound of 1/w_0, in steering lags.
  constexpr double kPeriods = 3.0;  // Lower bound of 1/w_0, in control periods.
  ErrorWeights weights = WeightsFor(vehicle, options);
  if (!options.steering_rate) {
    const double turn = speed * speed / vehicle.wheelbase;
    const double shortest =
        std::max(kLags * vehicle.steering_response.time_constant, kPeriods * period);
    const double slow = std::pow(shortest, 3) * turn;
    weights.steering_rate = std::max(weights.steering_rate, weights.cross_track * slow * slow);
  }
  return weights;
}

/// The linear-quadratic regulator of an error model with the state x. The control law w = -K x
/// minimizes the cost; the minimum cost is x^T P x.
struct Regulator {
  /// Matrix P of the minimum cost x^T P x, the solution of the Riccati equation.
  ErrorModel::Matrix cost;
  /// Gain K of the control law w = -K x.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, ErrorModel::kMaxStates> gain;
  double input_cost = 0.0;  ///< Quadratic coefficient R + b^T P b of the input w in the cost.
};

/// Computes the regulator from the solution P of the discrete Riccati equation. The doubling
/// algorithm (Chu et al. 2004) solves the Riccati equation to machine precision.
Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights);

/// Returns the diagonal of the matrix Q in the state's cost x^T Q x.
ErrorModel::Vector StateCost(const ErrorModel& model, const ErrorWeights& weights);

/// Computes, step by step, the disturbance g with which the path ahead acts on the error model. Let
/// x_0(k) be the steady turn at the path's curvature k steps ahead. The deviation z = x - x_0 from
/// the steady turn satisfies z(k+1) = a z(k) + b w(k) + g(k), with the steering rate w. The speed
/// on the path ahead is the planned speed plus the amount by which the car now exceeds the planned
/// speed. The speed on the path ahead determines the length of a step and the steady turn x_0(k). A
/// car that is much slower than planned is assumed to reach the planned speed or the minimum speed
/// of the model, whichever is smaller. The class Ahead looks along the path only up to the next
/// cusp or the path's end. If `path` is not null, the car follows the ramped path `path`, and
/// `tracking` must come from RampedPath::Track.
class Ahead {
 public:
  Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model,
        const RampedPath* path = nullptr);

  /// Returns the steady turn x_0 at the present step.
  [[nodiscard]] const ErrorModel::Vector& steady() const { return steady_; }
  /// Returns the speed and curvature that the car should have at the present step.
  [[nodiscard]] Motion Now() const { return MotionOn(curvature_); }
  /// Advances by one step of the error model and returns the disturbance g of this step. The
  /// disturbance g is zero while the curvature and the planned speed are constant. Without an
  /// argument, Next uses the error model that was given to the constructor. A given `model` must be
  /// made for the motion that Now returns.
  ErrorModel::Vector Next() { return Next(model_); }
  ErrorModel::Vector Next(const ErrorModel& model);
  /// Returns the steering rate of the steady turn in the last step of Next [rad/s], limited to the
  /// car's largest steering rate.
  [[nodiscard]] double rate() const { return rate_; }

 private:
  /// Returns the motion that a car should have at the present station, on a path of the given
  /// curvature.
  [[nodiscard]] Motion MotionOn(double curvature) const;

  const ControlInput& input_;
  const ErrorModel& model_;
  const RampedPath* path_;
  double station_;
  double excess_speed_;  // excess of the car's speed over the planned speed [m/s]
  int direction_;
  double curvature_;
  ErrorModel::Vector steady_;
  double yaw_;
  double rate_ = 0.0;
};

/// Returns the distance [m] that the car drives within `steps` steps of `period` [s], at the speeds
/// that the class Ahead assumes.
double DistanceAhead(const ControlInput& input, double period, long steps);

/// Returns the regulator for a car with a maximum steering rate `steering_rate` [rad/s]. For large
/// errors, the weight of the steering rate is doubled until neither offset nor heading error
/// commands more than twice the maximum steering rate. A scheduled gain that is low for large
/// errors stabilizes a chain of integrators with a saturated input from any initial state
/// (Megretski 1996). If the gain for small errors were also used for large errors, the car could
/// oscillate forever.
///
/// The offset in the deviation z is limited to the value at which the control law steers the car
/// toward the path at an angle of 0.6 rad. Without this limit, a large offset would make the linear
/// model turn toward the path by more than a right angle.
Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             ErrorModel::Vector& z);

}  // namespace trackbed

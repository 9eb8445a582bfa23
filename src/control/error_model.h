#pragma once

#include <Eigen/Core>
#include <optional>

#include "src/control/tracking.h"

namespace trackbed {

/// Linear model of a car's deviation from its path at constant speed u, in steps of constant
/// steering rate. LQR and MPC are based on this model.
///
/// The state x consists of offset e [m], heading error psi [rad], actuator angle delta and road
/// wheel angle delta_w. For a car with tyre coefficients, the state also contains the lateral speed
/// v and the yaw rate r at the center of gravity. The road wheels follow the actuator with the
/// car's steering lag.
///
/// The error dynamics follow Rajamani 2012, ch. 2, but e is the offset of the rear axle: e' = u psi
/// + v - l_r r and psi' = r - u kappa. The model is
///   x' = A x + B w + D kappa + C c.
/// The input w = delta' is the steering rate, and kappa the path's curvature. The constant c =
/// tan(delta_0) - delta_0 belongs to the steady turn with the angle delta_0. The lateral motion
/// depends on the tangent of the wheel angle, which the model linearizes at delta_0 with slope 1. A
/// car in a steady turn therefore stays on its path, at any curvature.
struct ErrorModel {
  static constexpr int kMaxStates = 6;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  double speed = 0.0;   ///< Signed speed u [m/s], never close to 0.
  double period = 0.0;  ///< Duration of a step [s].
  TyreForces tyres = TyreForces::kLinear;
  Matrix a;  ///< The state after a step is a x + b w + d kappa + c (tan(delta_0) - delta_0).
  Vector b;
  Vector d;
  Vector c;
};

/// Makes the model at the car's speed, in the path's direction of motion at the point nearest to
/// the car. The model's speed is at least the smaller of 2.46 L omega and 1 m/s, also for a car
/// that rolls backward.
///
/// With kBrush, the cornering stiffness C_f and C_r are evaluated in the turn at the path point
/// nearest to the car, with the planned acceleration. With kBrush, the steady turn is not a fixed
/// point of the linear model, but deviations of x from the steady turn still evolve by the matrix
/// `a`.
ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyres = TyreForces::kLinear);

/// Returns the model's state x for the car's present state.
ErrorModel::Vector ErrorState(const ControlInput& input, const Tracking& tracking,
                              TyreForces tyres = TyreForces::kLinear);

/// Integrates the steering rate to the commanded steering angle. The integration continues from the
/// last command, not from the actuator's angle. If the integration continued from the actuator's
/// angle, an actuator with a delay, backlash or a gain error of a tenth would never reach the
/// wanted angle. Feedback compensates the actuator's error, since the measured angle is part of the
/// state x.
class CommandedAngle {
 public:
  /// Returns the last commanded angle delta [rad]; before the first command, the actuator's angle.
  [[nodiscard]] double Now(const ControlInput& input) const;
  /// Returns the new commanded angle delta at the end of the control period [rad], clipped to the
  /// car's limits of steering rate and angle.
  double Turn(const ControlInput& input, double rate);

 private:
  std::optional<double> last_;
};

/// Weights of the cost function of LQR and MPC. The cost is the sum over all steps of
///   cross_track e^2 + heading (psi - psi_0)^2 + rate w^2.
struct ErrorWeights {
  double cross_track = 1.0;    ///< Weight of the offset [1/m^2], > 0.
  double heading = 1.0;        ///< Weight of the heading error [1/rad^2], >= 0.
  double steering_rate = 1.0;  ///< Weight of the steering rate [s^2/rad^2], > 0.
};

/// Converts the options of LQR or MPC to weights. The default weights measure offsets relative to
/// the wheelbase, and steering rates relative to the car's maximum rate. Therefore the default
/// weights suit cars of any size.
template <typename Options>
ErrorWeights WeightsFor(const VehicleParams& vehicle, const Options& options) {
  const CarScale scale = ComputeCarScale(vehicle);
  return {.cross_track = options.cross_track.value_or(1.0 / (scale.length * scale.length)),
          .heading = options.heading,
          .steering_rate = options.steering_rate.value_or(scale.time * scale.time)};
}

/// The linear-quadratic regulator of a model: w = -K x minimizes the cost, which is then x^T P x.
struct Regulator {
  /// Solution P of the Riccati equation.
  ErrorModel::Matrix cost;
  /// Gain K of the control law w = -K x.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, ErrorModel::kMaxStates> gain;
  double input_cost = 0.0;  ///< Cost R + b^T P b of the input.
};

/// Computes the regulator from the solution P of the discrete Riccati equation. The doubling
/// algorithm (Chu et al. 2004) solves the equation to machine precision.
Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights);

/// Returns the diagonal of the matrix that weights the state in the cost.
ErrorModel::Vector StateCost(const ErrorModel& model, const ErrorWeights& weights);

/// Computes, step by step, the disturbance g of the error model by the path ahead. Let x_0(k) be
/// the steady turn at the path's curvature k steps ahead. The deviation z = x - x_0 evolves by
/// z(k+1) = a z(k) + b w(k) + g(k). With kLinear, the speed on the path ahead is the car's present
/// speed. Otherwise, this speed is the planned speed plus the car's present excess over the planned
/// speed. The speed determines the length of a step and the steady turn x_0(k).
class Ahead {
 public:
  Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model);

  /// Returns the steady turn x_0 at the present step.
  [[nodiscard]] const ErrorModel::Vector& steady() const { return steady_; }
  /// Moves on to the next step and returns the step's disturbance g. The disturbance g is zero
  /// while the curvature and, except with kLinear, the planned speed are constant.
  ErrorModel::Vector Next();

 private:
  /// Returns the intended motion at the present station, on a path of the given curvature.
  [[nodiscard]] Motion MotionOn(double curvature) const;

  const ControlInput& input_;
  const ErrorModel& model_;
  double station_;
  double excess_speed_;  // excess of the car's speed over the planned speed [m/s]
  int direction_;
  double curvature_;
  ErrorModel::Vector steady_;
  double yaw_;
};

/// Returns the regulator for a car with a maximum steering rate `steering_rate` [rad/s]. For large
/// errors, the weight of the steering rate is doubled until neither offset nor heading error
/// commands more than twice the maximum rate. Such a scheduled gain, low for large errors,
/// stabilizes a chain of integrators behind a saturation from any state (Megretski 1996). With the
/// gain for small errors, the car could oscillate forever.
///
/// The offset in z is clamped to the offset from which the car approaches the path at 0.6 rad.
/// Without the clamp, a large offset would make the linear model turn toward the path by more than
/// a right angle.
Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             ErrorModel::Vector& z);

}  // namespace trackbed

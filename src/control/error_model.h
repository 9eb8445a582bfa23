#pragma once

#include <Eigen/Core>
#include <optional>

#include "src/control/tracking.h"

namespace trackbed {

/// Linear model of a car's deviation from its path at constant speed u, in steps of constant
/// steering rate. LQR and MPC are based on this model.
///
/// The state x consists of offset e [m], heading error psi [rad], actuator angle delta and road
/// wheel angle delta_w. For a car with tyres, the state also has v and r at the center of gravity.
/// The road wheels follow the actuator with the car's steering lag.
///
/// As in the (e, e', psi, psi') of Rajamani 2012, ch. 2, e' = u psi + v - l_r r and
/// psi' = r - u kappa. Unlike in Rajamani's model, e is the rear axle's offset. The model is
///   x' = A x + B w + D kappa + C c.
/// The input w = delta' is the steering rate, and kappa the path's curvature. For the steady turn,
/// c = tan(delta_0) - delta_0: the wheels act by the tangent of their angle, which the model
/// linearizes there with slope 1. A car in a steady turn therefore stays on its path, at any
/// curvature.
struct ErrorModel {
  static constexpr int kMaxStates = 6;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  double speed = 0.0;   ///< Speed u [m/s], signed, bounded away from 0.
  double period = 0.0;  ///< Duration of a step [s].
  TyreForces tyres = TyreForces::kLinear;
  Matrix a;  ///< x after a step = a x + b w + d kappa + c (tan(delta_0) - delta_0)
  Vector b;
  Vector d;
  Vector c;
};

/// Makes the model at the car's speed, in the direction of the path at the car's foot. A car that
/// rolls backward, or is slower than the smaller of 2.46 L omega and 1 m/s, gets the model of the
/// smaller speed.
///
/// With kBrush, C_f and C_r are those in the turn at the foot, with the planned acceleration. With
/// kBrush, the steady turn is no fixed point of the linear model, but deviations of x from the turn
/// evolve by `a`.
ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyres = TyreForces::kLinear);

/// The state x of the car.
ErrorModel::Vector ErrorState(const ControlInput& input, const Tracking& tracking,
                              TyreForces tyres = TyreForces::kLinear);

/// The commanded steering angle, changed by a rate. The commanded angle continues from the last
/// command, not from the actuator's angle. If the command continued from the actuator's angle, an
/// actuator with a delay, backlash or a gain error of a tenth would never reach the wanted angle.
/// Feedback compensates the error of the angle, since the measured angle is part of x.
class CommandedAngle {
 public:
  /// Commanded angle to continue from, delta [rad]; at first the actuator's angle.
  [[nodiscard]] double Now(const ControlInput& input) const;
  /// Commanded angle delta at the end of the period, within the car's limits of rate and angle.
  double Turn(const ControlInput& input, double rate);

 private:
  std::optional<double> last_;
};

/// Cost function of LQR and MPC. The cost is the sum over all steps of
///   cross_track e^2 + heading (psi - psi_0)^2 + rate w^2.
struct ErrorWeights {
  double cross_track = 1.0;    ///< Weight of the offset [1/m^2], > 0.
  double heading = 1.0;        ///< Weight of the heading error [1/rad^2], >= 0.
  double steering_rate = 1.0;  ///< Weight of the steering rate [s^2/rad^2], > 0.
};

/// Converts the options of LQR or MPC to weights. With default weights, cars of every size have
/// equal costs. Offsets count relative to the wheelbase, and steering rates relative to the car's
/// maximum.
template <typename Options>
ErrorWeights WeightsFor(const VehicleParams& vehicle, const Options& options) {
  const CarScale scale = ComputeCarScale(vehicle);
  return {.cross_track = options.cross_track.value_or(1.0 / (scale.length * scale.length)),
          .heading = options.heading,
          .steering_rate = options.steering_rate.value_or(scale.time * scale.time)};
}

/// The linear-quadratic regulator of a model: w = -K x minimizes the cost, which is then x^T P x.
struct Regulator {
  ErrorModel::Matrix cost;                                                                    ///< P
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, ErrorModel::kMaxStates> gain;  ///< K
  double input_cost = 0.0;  ///< R + b^T P b.
};

/// P of the discrete Riccati equation, by doubling (Chu et al. 2004), to machine precision.
Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights);

/// Diagonal of the state cost.
ErrorModel::Vector StateCost(const ErrorModel& model, const ErrorWeights& weights);

/// Disturbance by the path ahead, step by step. Let x_0(k) be the steady turn at the path's
/// curvature k steps ahead. The deviation z = x - x_0 evolves by z(k+1) = a z(k) + b w(k) + g(k).
/// The car's present speed determines the length of a step. With kBrush, the speed is the planned
/// speed plus the present excess of the car over it. With kBrush, the speed also determines the
/// turn x_0(k).
class Ahead {
 public:
  Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model);

  /// The steady turn x_0 at the present step.
  [[nodiscard]] const ErrorModel::Vector& steady() const { return steady_; }
  /// The disturbance g of the next step is zero while the curvature and, with kBrush, the speed
  /// stay constant.
  ErrorModel::Vector Next();

 private:
  /// The intended motion at the present station.
  [[nodiscard]] Motion MotionOn(double curvature) const;

  const ControlInput& input_;
  const ErrorModel& model_;
  double station_;
  double excess_speed_;  // excess of the car over the planned speed; used with kBrush [m/s]
  int direction_;
  double curvature_;
  ErrorModel::Vector steady_;
  double yaw_;
};

/// The regulator for a car with a maximum steering rate `steering_rate` [rad/s]. A larger offset or
/// heading error raises the weight of the rate. The weight is doubled until neither error commands
/// more than twice the maximum rate. With a scheduled gain that is low for large errors, a chain of
/// integrators behind a saturation converges from any state (Megretski 1996). With the gain for
/// small errors, the chain of integrators would oscillate forever.
///
/// The offset in z is clamped to an offset that is approached at 0.6 rad. For larger offsets, the
/// linear model would turn toward the path by more than a right angle.
Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             ErrorModel::Vector& z);

}  // namespace trackbed

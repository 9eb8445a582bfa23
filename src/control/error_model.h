#pragma once

#include <Eigen/Core>
#include <optional>

#include "src/control/tracking.h"

namespace trackbed {

/// Linear model of a car's deviation from its path at constant speed u, in steps of constant
/// steering rate. LQR and MPC are based on it.
///
/// State x: offset e [m], heading error psi [rad], actuator angle delta, angle delta_w of the road
/// wheels, which follow it with the car's steering lag and, for a car with tyres, v and r at the
/// center of gravity. As in the (e, e', psi, psi') of Rajamani 2012, ch. 2, e' = u psi + v - l_r r
/// and psi' = r - u kappa; here e is the rear axle's.
///   x' = A x + B w + D kappa + C c
/// w = delta' is the steering rate, kappa the path's curvature, and c = tan(delta_0) - delta_0 for
/// the steady turn: the wheels act by the tangent of their angle, linearized there with slope 1.
/// Thus a car in a steady turn stays on its path, at any curvature.
/// car on its path in a steady turn stays on it, however tight that is.
struct ErrorModel {
  static constexpr int kMaxStates = 6;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  double speed = 0.0;   ///< u [m/s], signed, bounded away from 0
  double period = 0.0;  ///< of a step [s]
  TyreForces tyres = TyreForces::kLinear;
  Matrix a;  ///< x after a step = a x + b w + d kappa + c (tan(delta_0) - delta_0)
  Vector b;
  Vector d;
  Vector c;
};

/// The model at the car's speed, in the direction of the path at its foot. Below 2.46 L omega (at
/// most 1 m/s), or if the car rolls backward, it uses that speed.
///
/// With kBrush, C_f and C_r are those in the turn at the foot with the planned acceleration. The
/// steady turn is then no fixed point of the linear model, but deviations of x from it evolve by
/// `a`.
ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyres = TyreForces::kLinear);

/// The state x of the car.
ErrorModel::Vector ErrorState(const ControlInput& input, const Tracking& tracking,
                              TyreForces tyres = TyreForces::kLinear);

/// The commanded angle, changed by a rate. It continues from the last command, not from the
/// actuator's angle: an actuator with a delay, backlash or a gain error of a tenth would otherwise
/// never reach the wanted angle. The measured angle is part of x, so feedback compensates its
/// error.
class CommandedAngle {
 public:
  /// delta [rad] to continue from; at first the actuator's angle.
  [[nodiscard]] double Now(const ControlInput& input) const;
  /// delta at the end of the period, within the car's limits of rate and angle.
  double Turn(const ControlInput& input, double rate);

 private:
  std::optional<double> last_;
};

/// Cost function of LQR and MPC: the sum over all steps of
///   cross_track e^2 + heading (psi - psi_0)^2 + rate w^2.
struct ErrorWeights {
  double cross_track = 1.0;    ///< [1/m^2], > 0
  double heading = 1.0;        ///< [1/rad^2], >= 0
  double steering_rate = 1.0;  ///< [s^2/rad^2], > 0
};

/// The weights of LqrOptions or MpcOptions. Default weights make the cost of an error equal for
/// cars of every size: of an offset relative to the wheelbase, and of a steering rate relative to
/// the car's maximum.
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
  double input_cost = 0.0;  ///< R + b^T P b
};

/// P of the discrete Riccati equation, by doubling (Chu et al. 2004), to machine precision.
Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights);

/// Diagonal of the state cost.
ErrorModel::Vector StateCost(const ErrorModel& model, const ErrorWeights& weights);

/// Disturbance by the path ahead, step by step. With x_0(k), the steady turn at the path's
/// curvature k steps ahead, z = x - x_0 evolves by z(k+1) = a z(k) + b w(k) + g(k). The length of a
/// step follows from the car's present speed. With kBrush it follows from the planned speed plus
/// the car's present excess over it; this speed also determines the turn x_0(k).
class Ahead {
 public:
  Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model);

  /// x_0 at the present step.
  [[nodiscard]] const ErrorModel::Vector& steady() const { return steady_; }
  /// g of the next step: zero while the curvature and, with kBrush, the speed stay constant.
  ErrorModel::Vector Next();

 private:
  /// The intended motion at the present station.
  [[nodiscard]] Motion MotionOn(double curvature) const;

  const ControlInput& input_;
  const ErrorModel& model_;
  double station_;
  double excess_speed_;  // over the planned speed; used with kBrush [m/s]
  int direction_;
  double curvature_;
  ErrorModel::Vector steady_;
  double yaw_;
};

/// The regulator for a car with a maximum steering rate `steering_rate` [rad/s]. The larger the
/// offset or heading error, the more it raises the rate's weight: by powers of two, until neither
/// error commands more than twice the maximum rate. With such a low scheduled gain, a chain of
/// integrators behind a saturation converges from any state (Megretski 1996); with the gain for
/// small errors it would oscillate forever.
///
/// Clamps the offset in z to one that is approached at 0.6 rad: for larger offsets the linear model
/// would turn toward the path by more than a right angle.
Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             ErrorModel::Vector& z);

}  // namespace trackbed

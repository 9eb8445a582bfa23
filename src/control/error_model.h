#pragma once

#include <Eigen/Core>
#include <optional>

#include "src/control/tracking.h"

namespace trackbed {

/// The linear model of a car beside its path at constant speed u, over steps of constant steering
/// rate: what LQR and MPC reckon with.
///
/// State x: e [m], psi [rad], delta where the actuator stands, delta_w the road wheels behind it
/// (tau: the car's steering lag) and, for a car with tyres, v and r at the center of gravity. As
/// in the (e, e', psi, psi') of Rajamani 2012, ch. 2, e' = u psi + v - l_r r and psi' = r - u
/// kappa; here e is the rear axle's.
///   x' = A x + B w + D kappa + C c
/// w = delta' the steering rate, kappa the path's curvature, and c = tan(delta_0) - delta_0 of the
/// steady turn: the wheels act with their tangent, which is linearized there with slope 1. Thus a
/// car on its path in a steady turn stays on it, however tight that is.
struct ErrorModel {
  static constexpr int kMaxStates = 6;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  double speed = 0.0;   ///< u [m/s], signed, never too near 0
  double period = 0.0;  ///< of a step [s]
  TyreForces tyres = TyreForces::kLinear;
  Matrix a;  ///< x after a step = a x + b w + d kappa + c (tan(delta_0) - delta_0)
  Vector b;
  Vector d;
  Vector c;
};

/// The model at the speed that the car has, in the direction of the path at its foot. A car at a
/// crawl or rolling the other way is reckoned with
/// 2.46 L omega that way, 1 m/s at most.
///
/// kBrush: C_f and C_r are those about the turn at the foot with the planned acceleration. The
/// steady turn is not the linear model's fixed point, but x's deviation from it runs by `a`.
ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyres = TyreForces::kLinear);

/// x of the car now.
ErrorModel::Vector ErrorState(const ControlInput& input, const Tracking& tracking,
                              TyreForces tyres = TyreForces::kLinear);

/// The angle that is asked for, turned by a rate. It goes on from what was asked before, not from
/// where the actuator stands: an actuator that is late, has play or gives a tenth too little would
/// else never get anywhere. Its angle, as measured, is in x, so that what it lacks is made up for.
class CommandedAngle {
 public:
  /// delta [rad] to go on from; at first the actuator's.
  [[nodiscard]] double Now(const ControlInput& input) const;
  /// delta at the end of the period, both within the car's limits.
  double Turn(const ControlInput& input, double rate);

 private:
  std::optional<double> last_;
};

/// What LQR and MPC minimize: the sum over all steps of
///   cross_track e^2 + heading (psi - psi_0)^2 + rate w^2.
struct ErrorWeights {
  double cross_track = 1.0;    ///< [1/m^2], > 0
  double heading = 1.0;        ///< [1/rad^2], >= 0
  double steering_rate = 1.0;  ///< [s^2/rad^2], > 0
};

/// Of LqrOptions or MpcOptions. The weights that these leave open make the cost of an error the
/// same for cars of every size: of an offset over the wheelbase, and of the steering rate over that
/// of the car.
template <typename Options>
ErrorWeights WeightsFor(const VehicleParams& vehicle, const Options& options) {
  const CarScale scale = ComputeCarScale(vehicle);
  return {.cross_track = options.cross_track.value_or(1.0 / (scale.length * scale.length)),
          .heading = options.heading,
          .steering_rate = options.steering_rate.value_or(scale.time * scale.time)};
}

/// The linear-quadratic regulator for a model: the cost of x off the path is x^T P x, and
/// w = -K x keeps it lowest.
struct Regulator {
  ErrorModel::Matrix cost;                                                                    ///< P
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, ErrorModel::kMaxStates> gain;  ///< K
  double input_cost = 0.0;  ///< R + b^T P b
};

/// P from the discrete Riccati equation, by doubling (Chu et al. 2004), to rounding.
Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights);

/// Diagonal of the cost of x.
ErrorModel::Vector StateCost(const ErrorModel& model, const ErrorWeights& weights);

/// How x may stray from the steady turns of the path ahead, step by step: with x_0(k) the steady
/// turn at the path's curvature k steps ahead, z = x - x_0 runs as z(k+1) = a z(k) + b w(k) + g(k).
/// A step goes as far as the car's present speed takes it; with kBrush, as the planned one does,
/// plus what the car is now faster than planned, and x_0(k) is the turn at that speed.
class Ahead {
 public:
  Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model);

  /// x_0 now.
  [[nodiscard]] const ErrorModel::Vector& steady() const { return steady_; }
  /// g of the next step: zero while the curvature stays, with kBrush also the speed.
  ErrorModel::Vector Next();

 private:
  /// At the station.
  [[nodiscard]] Motion MotionOn(double curvature) const;

  const ControlInput& input_;
  const ErrorModel& model_;
  double station_;
  double excess_speed_;  // over the planned one, which counts with kBrush [m/s]
  int direction_;
  double curvature_;
  ErrorModel::Vector steady_;
  double yaw_;
};

/// The regulator for a car whose wheels turn no faster than `steering_rate` [rad/s]. The further it
/// is off its path, by offset or by heading, the more the rate's weight is raised above its own: by
/// powers of two, until neither asks for more than twice the rate that there is. With the gain
/// scheduled so low, a chain of integrators behind a saturation comes to rest from anywhere
/// (Megretski 1996); with that of a car on its path it would swing for ever.
///
/// The offset in z is brought down to one that is approached at 0.6 rad: further away the linear
/// model would turn to the path by more than a right angle.
Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             ErrorModel::Vector& z);

}  // namespace trackbed

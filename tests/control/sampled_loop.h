#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"

// The linear sampled loop of a controller and a single-track car on a straight path, made without
// the car models and the actuator model of the product.
namespace trackbed {

/// A controller that steers a car at constant speed on a straight path.
struct LoopCase {
  ControllerEntry controller;
  VehicleParams vehicle;
  double speed = 10.0;   // [m/s]
  double period = 0.02;  // Control period [s].
  ActuatorKnowledge knowledge = ActuatorKnowledge::kModel;
};

/// Derivatives of the steering angle [rad] that a control law wants.
struct SteeringGains {
  /// For offset e [m], heading error psi [rad], lateral speed v [m/s] and yaw rate r [rad/s].
  Eigen::Vector4d car;
  double wheels = 0.0;    ///< For the measured angle of the road wheels.
  double actuator = 0.0;  ///< For the measured angle of the actuator.
  double last = 0.0;      ///< For the last wanted angle.
};

/// The linear loop z(k+1) = matrix z(k) over control periods. The first four elements of z are e,
/// psi, v and r.
struct SampledLoop {
  Eigen::MatrixXd matrix;

  [[nodiscard]] double SpectralRadius() const { return matrix.eigenvalues().cwiseAbs().maxCoeff(); }
};

namespace sampled_loop {

/// Timesteps of the steering filter in a control period.
inline constexpr int kSubsteps = 10;
/// Ratio of the actuator's lag to the lag that the lead of the actuator model leaves.
inline constexpr double kLead = 3.0;

/// Returns the vehicle that the control law inside of the actuator model receives.
inline VehicleParams InnerVehicle(const LoopCase& loop) {
  VehicleParams vehicle = loop.vehicle;
  vehicle.steering_response = {};
  if (loop.knowledge == ActuatorKnowledge::kModel) {
    vehicle.steering_response.time_constant = loop.vehicle.steering_response.time_constant / kLead;
  } else {
    vehicle.steering_lag = 0.0;
  }
  return vehicle;
}

/// Returns the angle that a new controller wants in a state z = (e, psi, v, r, wheels, actuator).
/// If `primed`, the last wanted angle is 0, otherwise the angle of the actuator.
inline double Wanted(const LoopCase& loop, const Eigen::Matrix<double, 6, 1>& z, bool primed) {
  const VehicleParams vehicle = InnerVehicle(loop);
  const Reference reference{Path({}, {{1e4, 0.0, 1}}), SpeedProfile({{0.0, loop.speed}})};
  constexpr double kStation = 1e3;
  const auto controller = loop.controller.make(loop.controller.defaults);
  const auto steer = [&](const Eigen::Matrix<double, 6, 1>& at) {
    VehicleState state;
    state.pose = {kStation, at[0], at[1]};
    state.speed = loop.speed;
    state.lateral_speed = at[2];
    state.yaw_rate = at[3];
    state.steering = at[4];
    state.steering_actuator = at[5];
    return controller->Steer({.vehicle = vehicle,
                              .reference = reference,
                              .schedule = {},
                              .state = state,
                              .station = kStation,
                              .period = loop.period});
  };
  if (primed) {
    steer(Eigen::Matrix<double, 6, 1>::Zero());
  }
  return steer(z);
}

/// Computes the gains by central differences.
inline SteeringGains Gains(const LoopCase& loop) {
  // TimelySteering adds a term in z |z|, with an effect c h on the difference D(h). 2 D(h/2) - D(h)
  // is free of it. The remaining error is of the order of h^2, and rounding of 1e-16/h.
  constexpr double h = 1e-5;
  const auto difference = [&](int i, bool primed, double step) {
    Eigen::Matrix<double, 6, 1> z = Eigen::Matrix<double, 6, 1>::Zero();
    z[i] = step;
    return (Wanted(loop, z, primed) - Wanted(loop, -z, primed)) / (2.0 * step);
  };
  const auto derivative = [&](int i, bool primed) {
    return 2.0 * difference(i, primed, 0.5 * h) - difference(i, primed, h);
  };
  SteeringGains gains;
  for (int i = 0; i < 4; ++i) {
    gains.car[i] = derivative(i, false);
  }
  gains.wheels = derivative(4, false);
  gains.actuator = derivative(5, true);
  gains.last = derivative(5, false) - gains.actuator;
  return gains;
}

/// Returns the matrix of (e, psi, v, r, delta) over a timestep `h` with the constant steering angle
/// delta (Rajamani 2012, ch. 2, with the offset of the rear axle).
inline Eigen::Matrix<double, 5, 5> CarStep(const VehicleParams& car, double u, double h) {
  const double front = car.cornering_stiffness_front;
  const double rear = car.cornering_stiffness_rear;
  const double l_f = car.wheelbase - car.cg_to_rear;
  const double l_r = car.cg_to_rear;
  Eigen::Matrix<double, 5, 5> rates = Eigen::Matrix<double, 5, 5>::Zero();
  rates.row(0) << 0.0, u, 1.0, -l_r, 0.0;
  rates.row(1) << 0.0, 0.0, 0.0, 1.0, 0.0;
  // The slip angles of the axles are delta - (v + l_f r)/u and -(v - l_r r)/u.
  rates.row(2) << 0.0, 0.0, -(front + rear) / u, -(l_f * front - l_r * rear) / u, front;
  rates.row(3) << 0.0, 0.0, -(l_f * front - l_r * rear) / u,
      -(l_f * l_f * front + l_r * l_r * rear) / u, l_f * front;
  rates.row(2) /= car.mass;
  rates(2, 3) -= u;
  rates.row(3) /= car.yaw_inertia;
  const Eigen::Matrix<double, 5, 5> scaled = rates * h;
  return scaled.exp();
}

/// Returns the matrix of (e, psi, v, r, s, c) over a control period, in which the angle s of the
/// wheels follows the constant command c with the lag of the actuator. As in SteeringFilter, the
/// angle is constant over a timestep.
inline Eigen::MatrixXd PlantStep(const LoopCase& loop) {
  const double h = loop.period / kSubsteps;
  const double lag = loop.vehicle.steering_response.time_constant;
  const double decay = lag > 0.0 ? std::exp(-h / lag) : 0.0;
  Eigen::MatrixXd lagged = Eigen::MatrixXd::Identity(6, 6);
  lagged(4, 4) = decay;
  lagged(4, 5) = 1.0 - decay;
  Eigen::MatrixXd car = Eigen::MatrixXd::Identity(6, 6);
  car.topLeftCorner<5, 5>() = CarStep(loop.vehicle, loop.speed, h);
  const Eigen::MatrixXd substep = car * lagged;
  Eigen::MatrixXd step = Eigen::MatrixXd::Identity(6, 6);
  for (int i = 0; i < kSubsteps; ++i) {
    step = (substep * step).eval();
  }
  return step;
}

/// The loop without dead time, in the state (e, psi, v, r, s, w), where w is the last wanted angle.
/// An exact Smith predictor gives the loop with dead time the same eigenvalues, and zeros.
inline SampledLoop CompensatedLoop(const LoopCase& loop) {
  const SteeringGains gains = Gains(loop);
  const double lag = loop.vehicle.steering_response.time_constant;
  const double lead =
      lag > 0.0 ? std::expm1(-kLead * loop.period / lag) / std::expm1(-loop.period / lag) : 1.0;
  // The actuator model reports the last wanted angle as the angle of the actuator.
  Eigen::MatrixXd wanted(1, 6);
  wanted << gains.car.transpose(), gains.wheels, gains.actuator + gains.last;
  Eigen::MatrixXd command = lead * wanted;
  command(0, 4) += 1.0 - lead;
  const Eigen::MatrixXd plant = PlantStep(loop);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
  matrix.topRows(5) = plant.topLeftCorner(5, 6);
  matrix.topRightCorner(5, 1).setZero();
  matrix.topRows(5) += plant.block(0, 5, 5, 1) * command;
  matrix.row(5) = wanted;
  return {matrix};
}

/// The loop of a controller that ignores the actuator, in the state (e, psi, v, r, s, c_1, ...,
/// c_n, c_(n+1)): the last commands, the newest one first. The dead time has n control periods.
inline SampledLoop IgnorantLoop(const LoopCase& loop) {
  const SteeringGains gains = Gains(loop);
  const auto n = std::lround(loop.vehicle.steering_response.dead_time / loop.period);
  const Eigen::Index size = 5 + n + 1;
  Eigen::MatrixXd command = Eigen::MatrixXd::Zero(1, size);
  command.leftCols(4) = gains.car.transpose();
  command(0, 4) = gains.wheels + gains.actuator;
  command(0, 5) = gains.last;
  const Eigen::MatrixXd plant = PlantStep(loop);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  matrix.topLeftCorner(5, 5) = plant.topLeftCorner(5, 5);
  if (n == 0) {
    matrix.topRows(5) += plant.block(0, 5, 5, 1) * command;
  } else {
    matrix.block(0, 5 + n - 1, 5, 1) = plant.block(0, 5, 5, 1);
  }
  matrix.row(5) = command;
  for (Eigen::Index i = 6; i < size; ++i) {
    matrix(i, i - 1) = 1.0;
  }
  return {matrix};
}

}  // namespace sampled_loop

/// Makes the linear loop of a controller whose law has derivatives on the path, and of a car with
/// tyres. The calibration curve and the backlash of the actuator are left out. If the controller
/// ignores the actuator, its dead time must be a whole number of control periods.
inline SampledLoop MakeSampledLoop(const LoopCase& loop) {
  return loop.knowledge == ActuatorKnowledge::kModel ? sampled_loop::CompensatedLoop(loop)
                                                     : sampled_loop::IgnorantLoop(loop);
}

}  // namespace trackbed

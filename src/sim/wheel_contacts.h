#pragma once

#include <Eigen/Core>
#include <array>

#include "trackbed/sim/car_model.h"

struct mjData_;

/// Computes the motion of a MuJoCo car's wheels and the forces on the wheels at their contacts with
/// the road.
namespace trackbed {

/// The contact of one wheel with the road. All vectors of a WheelContact are in the world frame.
/// The tyre's axes `forward`, `left` and `up` point forward, to the left, and up along the road's
/// normal.
struct WheelContact {
  bool touches = false;
  Eigen::Vector3d point;
  Eigen::Vector3d forward;
  Eigen::Vector3d left;
  Eigen::Vector3d up;
  /// Unit vector along the wheel's spin axis, pointing to the left.
  Eigen::Vector3d spin_axis;
  Eigen::Vector3d hub_velocity;      ///< Velocity of the wheel's hub [m/s].
  Eigen::Vector3d angular_velocity;  ///< Angular velocity of the wheel [rad/s].
  double rolling_speed = 0.0;        ///< Forward speed v_x of the wheel's hub [m/s].
  /// Angular speed Omega of the wheel about its spin axis, positive for forward rolling [rad/s].
  double spin = 0.0;
  /// Longitudinal slip speed Omega R - v_x [m/s] with the wheel radius R: the backward speed of the
  /// contact patch over the road.
  double slip_speed_x = 0.0;
  /// Lateral speed v_y of the contact patch over the road, positive to the left [m/s].
  double slip_speed_y = 0.0;
};

/// Computes the motion of a wheel of the given `radius` [m] that touches the road at `point`, from
/// the positions and velocities in `data`. `body` is the index of the wheel's body, and `up` is the
/// road's normal at `point`.
WheelContact ContactAt(const mjModel_& model, const mjData_& data, int body, double radius,
                       const Eigen::Vector3d& point, const Eigen::Vector3d& up);

/// Computes the motion of the car's wheel with the index `wheel`, which touches the road at
/// `point`.
WheelContact ContactAt(const CarModel& car, const mjModel_& model, const mjData_& data,
                       std::size_t wheel, const Eigen::Vector3d& point, const Eigen::Vector3d& up);

/// Returns the contacts of all wheels with the road, as found by MuJoCo. For a wheel in the air,
/// the returned contact assumes a level road below the wheel.
std::array<WheelContact, 4> FindWheelContacts(const CarModel& car, const mjModel_& model,
                                              const mjData_& data);

/// Returns the contact force of the road on each wheel, from MuJoCo's last call of the constraint
/// solver, in the world frame [N].
std::array<Eigen::Vector3d, 4> RoadForces(const CarModel& car, const mjModel_& model,
                                          const mjData_& data);

/// Returns the states of all wheels of a car on contact tyres. The friction coefficients of the
/// tyres' geoms in `model` already include the road's friction factor.
std::array<WheelState, 4> ContactWheelStates(const CarModel& car, const mjModel_& model,
                                             const mjData_& data);

}  // namespace trackbed

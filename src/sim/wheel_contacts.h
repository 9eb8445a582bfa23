#pragma once

#include <Eigen/Core>
#include <array>

#include "trackbed/sim/car_model.h"

struct mjData_;

/// Motion and forces of the MuJoCo car's wheels at their contacts with the road.
namespace trackbed {

/// One wheel at its contact with the road. Vectors are in the world frame. The tyre axes are
/// forward, left and up (the road's normal).
struct WheelContact {
  bool touches = false;
  Eigen::Vector3d point;
  Eigen::Vector3d forward;
  Eigen::Vector3d left;
  Eigen::Vector3d up;
  Eigen::Vector3d spin_axis;         ///< Unit vector along the spin axis, to the left.
  Eigen::Vector3d hub_velocity;      ///< Velocity of the hub [m/s].
  Eigen::Vector3d angular_velocity;  ///< Angular velocity of the wheel [rad/s].
  double rolling_speed = 0.0;        ///< Forward speed v_x of the hub [m/s].
  double spin = 0.0;                 ///< Spin Omega about the spin axis, positive forward [rad/s].
  double slip_speed_x = 0.0;  ///< Omega R - v_x, against the patch's motion over the road [m/s].
  double slip_speed_y = 0.0;  ///< Speed v_y of the patch over the road, to the left [m/s].
};

/// Motion of a wheel that touches at `point`, from the present positions and velocities. `up` is
/// the road's normal at `point`.
WheelContact ContactAt(const CarModel& car, const mjModel_& model, const mjData_& data,
                       std::size_t wheel, const Eigen::Vector3d& point, const Eigen::Vector3d& up);

/// Contacts of all wheels, found by MuJoCo. A wheel in the air is treated as one on a level road.
std::array<WheelContact, 4> FindWheelContacts(const CarModel& car, const mjModel_& model,
                                              const mjData_& data);

/// The road's contact forces on the wheels in the last solver call, in the world frame [N].
std::array<Eigen::Vector3d, 4> RoadForces(const CarModel& car, const mjModel_& model,
                                          const mjData_& data);

}  // namespace trackbed

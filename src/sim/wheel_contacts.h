#pragma once

#include <Eigen/Core>
#include <array>

#include "trackbed/sim/car_model.h"

struct mjData_;

/// How the wheels of the MuJoCo car meet the road.
namespace trackbed {

/// One wheel at its contact with the road. World frame; tyre axes forward, left, up (the road's
/// normal).
struct WheelContact {
  bool touches = false;
  Eigen::Vector3d point;
  Eigen::Vector3d forward;
  Eigen::Vector3d left;
  Eigen::Vector3d up;
  Eigen::Vector3d spin_axis;   ///< to the left
  double rolling_speed = 0.0;  ///< v_x: of the hub, forward [m/s]
  double spin = 0.0;           ///< Omega about the spin axis, forward positive [rad/s]
  double slip_speed_x = 0.0;   ///< Omega R - v_x: against the patch's motion over the road [m/s]
  double slip_speed_y = 0.0;   ///< v_y: of the patch over the road, to the left [m/s]
};

/// Where the wheels touch and how they move, from the positions and velocities now. A wheel in the
/// air counts as standing on a level road.
std::array<WheelContact, 4> FindWheelContacts(const CarModel& car, const mjModel_& model,
                                              const mjData_& data);

/// What presses the wheels on the road [N], >= 0, of the last solve.
std::array<double, 4> RoadLoads(const CarModel& car, const mjModel_& model, const mjData_& data);

/// The road's contact forces on the wheels [N], world frame, of the last solve.
std::array<Eigen::Vector3d, 4> RoadForces(const CarModel& car, const mjModel_& model,
                                          const mjData_& data);

}  // namespace trackbed

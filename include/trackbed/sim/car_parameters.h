#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

/// The numbers of a car's model, by name, to read and to replace.
///
/// Names are those of the numerics under <custom> (docs/models.md), `p_ky1_front`, with an index
/// for one of several, `steering_curve[1]`, counted from 0; and
///
///   mass          of the whole vehicle [kg]
///   cg_to_rear    its center of gravity ahead of the rear axle [m]
///   cg_height     of its center of gravity over the road at rest [m]
///   yaw_inertia   about its center of gravity [kg m^2]
///   steering_rate, steering_limit  of the actuator `steer` [rad/s], [rad]
///   drive_torque  largest, on all driven wheels together [N m]
///
/// `p_ky1_front` is there, too, where the model has only `p_ky1`, which applies to both axles.
namespace trackbed {

struct CarParameter {
  std::string name;
  double value = 0.0;
  std::string origin{};  ///< written as a comment beside it; empty: none
};

/// The value of a number in the model. InputError naming the car's file, with the nearest spelling,
/// when it has none of that name.
double CarParameterValue(const CarModel& car, const std::string& name);

/// The car's scene with these numbers instead of its own; no name twice.
///
/// Masses and inertias change in the body `chassis` alone, which needs an <inertial>; the springs
/// (slide joints between chassis and wheels) are preloaded so that the car still stands at zero
/// travel. A number that the model did not have, `p_ky1_front`, is added.
///
/// Errors: InputError as above, for a chassis without <inertial>, and for values that leave the
/// chassis without mass or inertia. What else the values break shows when the scene is compiled to
/// a CarModel. Cost: parsing and printing the model, below 1 ms.
Scene WithCarParameters(const CarModel& car, const std::vector<CarParameter>& parameters);

}  // namespace trackbed

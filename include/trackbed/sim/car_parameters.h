#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

/// Reads and replaces the numeric parameters of a car's model by name.
///
/// Every numeric under <custom> in the model is a parameter with the same name (docs/models.md),
/// such as `p_ky1_front`. A single value of a list is named by its index from 0, such as
/// `steering_curve[1]`. The other parameters are:
///
///   mass            mass of the whole vehicle [kg]
///   cg_to_rear      distance from the rear axle forward to the vehicle's center of gravity [m]
///   cg_height       height of the vehicle's center of gravity over the road, at rest [m]
///   yaw_inertia     yaw inertia of the vehicle about its center of gravity [kg m^2]
///   steering_rate   rate limit of the actuator `steer` [rad/s]
///   steering_limit  angle limit of the actuator `steer` [rad]
///   drive_torque    largest drive torque on all driven wheels together [N m]
///
/// The parameter `p_ky1_front` also exists if the model has only `p_ky1`, which applies to both
/// axles.
namespace trackbed {

struct CarParameter {
  std::string name;
  double value = 0.0;
  std::string origin{};  ///< Comment that is written next to the parameter in the model; empty: no
                         ///< comment.
};

/// Returns the value of a parameter in the model. For an unknown name, throws InputError, which
/// names the car's file and suggests the most similar name.
double CarParameterValue(const CarModel& car, const std::string& name);

/// Returns the car's scene with the given parameter values. Each name may occur only once.
///
/// Changes of mass and inertia affect only the body `chassis`, which needs an <inertial>. The
/// preload of the springs (slide joints between chassis and wheels) is adjusted, so that the
/// springs still have zero travel at rest. A parameter that the model did not have yet, such as
/// `p_ky1_front`, is added.
///
/// Errors: InputError for an unknown name, for a chassis without <inertial>, and for values that
/// leave the chassis without mass or inertia. Other invalid values are detected when the scene is
/// compiled to a CarModel. Cost: less than 1 ms for parsing and printing the model.
Scene WithCarParameters(const CarModel& car, const std::vector<CarParameter>& parameters);

}  // namespace trackbed

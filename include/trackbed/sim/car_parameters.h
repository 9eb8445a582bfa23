#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

/// Reads and replaces the numeric parameters of a car's model by name.
///
/// Every element `numeric` under <custom> in the model is a parameter of the same name
/// (docs/models.md), such as `p_ky1_front`. A single value of a list is selected by its index,
/// counted from 0, such as `steering_curve[1]`. The parameters that are not under <custom> are:
///
///   mass            mass of the whole vehicle [kg]
///   cg_to_rear      distance from the rear axle forward to the vehicle's center of gravity [m]
///   cg_height       height of the vehicle's center of gravity over the road, at rest [m]
///   yaw_inertia     yaw inertia of the vehicle about its center of gravity [kg m^2]
///   steering_rate   rate limit of the actuator `steer` [rad/s]
///   steering_limit  angle limit of the actuator `steer` [rad]
///   drive_torque    largest drive torque on all driven wheels together [N m]
///   steering_offset constant angle of the road wheels that is added to the commanded angle, or to
///                   the angles of `steering_curve` [rad], positive to the left; 0 if the model has
///                   no such number
///
/// The name `p_ky1_front` is also valid if the model has only the parameter `p_ky1`, which applies
/// to both axles.
namespace trackbed {

/// Name of the parameter steering_offset.
inline constexpr const char* kSteeringOffset = "steering_offset";

struct CarParameter {
  std::string name;
  double value = 0.0;
  /// Comment that is written next to the changed parameter in the MJCF model; empty: no comment.
  std::string origin{};
};

/// Returns the value of a parameter in the model of a car. Throws InputError, which names the car's
/// file and suggests the most similar name, if no parameter has this name.
double CarParameterValue(const CarModel& car, const std::string& name);

/// Returns the car's scene with the given parameter values. Each parameter name may occur only
/// once.
///
/// Changes of mass and inertia affect only the body `chassis`, which needs an <inertial>. The
/// preload of the springs (slide joints between chassis and wheels) is adjusted, so that the
/// springs still have zero travel at rest. A parameter that the model does not have yet, such as
/// `p_ky1_front`, is added to the model.
///
/// Errors: throws InputError if a name is unknown, if the chassis has no <inertial>, or if the
/// values leave the chassis without mass or inertia. Invalid parameter values that
/// WithCarParameters accepts are detected only when the scene is compiled to a CarModel.
/// WithCarParameters takes less than 1 ms, for parsing and printing the MJCF model.
Scene WithCarParameters(const CarModel& car, const std::vector<CarParameter>& parameters);

}  // namespace trackbed

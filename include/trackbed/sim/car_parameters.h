#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

/// Reads and replaces the numeric parameters of a car's model by name.
///
/// The names include those of the numerics under <custom> (docs/models.md), such as `p_ky1_front`.
/// One of several values has an index from 0, such as `steering_curve[1]`. Further names are
///
///   mass          of the whole vehicle [kg]
///   cg_to_rear    its center of gravity ahead of the rear axle [m]
///   cg_height     of its center of gravity over the road at rest [m]
///   yaw_inertia   about its center of gravity [kg m^2]
///   steering_rate, steering_limit  of the actuator `steer` [rad/s], [rad]
///   drive_torque  largest, on all driven wheels together [N m]
///
/// `p_ky1_front` also exists if the model only has `p_ky1`, which applies to both axles.
namespace trackbed {

struct CarParameter {
  std::string name;
  double value = 0.0;
  std::string origin{};  ///< Comment beside the parameter in the model; empty: none.
};

/// Returns the value of a parameter in the model. For an unknown name, InputError naming the car's
/// file and the nearest spelling.
double CarParameterValue(const CarModel& car, const std::string& name);

/// Returns the car's scene with the given parameter values. Each name may occur only once.
///
/// Masses and inertias only change in the body `chassis`, which needs an <inertial>. The springs
/// (slide joints between chassis and wheels) are preloaded so that the car still stands at zero
/// travel. A parameter that the model did not have, such as `p_ky1_front`, is added.
///
/// Errors: InputError for an unknown name, for a chassis without <inertial>, and for values that
/// leave the chassis without mass or inertia. Other invalid values are detected when the scene is
/// compiled to a CarModel. Cost: parsing and printing the model, below 1 ms.
Scene WithCarParameters(const CarModel& car, const std::vector<CarParameter>& parameters);

}  // namespace trackbed

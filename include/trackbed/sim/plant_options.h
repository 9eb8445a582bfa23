#pragma once

#include <optional>

#include "trackbed/geometry/pose.h"

/// What a plant starts from and is made of, apart from car and world.
namespace trackbed {

/// The initial state of a run.
struct StartState {
  Pose2 pose;             ///< rear-axle center
  double speed = 0.0;     ///< [m/s]
  double steering = 0.0;  ///< bicycle angle, wheels and actuator alike [rad]
  /// Of the rear axle, along y [m/s]. None: it rolls without slip. For plants that can slip.
  std::optional<double> lateral_speed{};
  std::optional<double> yaw_rate{};  ///< [rad/s]; likewise
};

/// The tyre model of the MuJoCo plant.
enum class TyreLaw {
  kAuto,          ///< the Magic Formula for cars whose file has its coefficients, else contacts
  kContact,       ///< MuJoCo's friction cone: negligible slip below the friction limit
  kMagicFormula,  ///< forces grow with slip (vehicle/magic_formula.h); contacts carry the load
                  ///< alone
};

/// How the commanded steering angle reaches the road wheels.
enum class SteeringInput {
  kActuator,    ///< through the car's actuator, within its rate and angle
  kPrescribed,  ///< exactly and at once, for validation
};

}  // namespace trackbed

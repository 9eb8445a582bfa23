#pragma once

#include <optional>

#include "trackbed/geometry/pose.h"

/// Options of a plant, in addition to car and world.
namespace trackbed {

/// The initial state of a run.
struct StartState {
  Pose2 pose;             ///< rear-axle center
  double speed = 0.0;     ///< [m/s]
  double steering = 0.0;  ///< bicycle angle of both wheels and actuator [rad]
  /// Of the rear axle, along y [m/s]; none: no slip. Only for plants that can slip.
  std::optional<double> lateral_speed{};
  std::optional<double> yaw_rate{};  ///< [rad/s]; none: no slip
};

/// The tyre model of the MuJoCo plant.
enum class TyreLaw {
  kAuto,     ///< the Magic Formula for cars whose file has its coefficients, else contacts
  kContact,  ///< MuJoCo's friction cone: negligible slip below the friction limit
  /// Forces grow with slip (vehicle/magic_formula.h); contacts only carry the load.
  kMagicFormula,
};

/// How the commanded steering angle reaches the road wheels.
enum class SteeringInput {
  kActuator,    ///< through the car's actuator, within its rate and angle limits
  kPrescribed,  ///< exactly and at once, for validation
};

}  // namespace trackbed

#pragma once

#include <optional>

#include "trackbed/geometry/pose.h"

/// Options of a plant, in addition to car and world.
namespace trackbed {

/// The initial state of a run.
struct StartState {
  Pose2 pose;             ///< Position of the rear-axle center, and yaw.
  double speed = 0.0;     ///< Speed [m/s].
  double steering = 0.0;  ///< Angle of wheels and actuator in the bicycle model [rad].
  /// Lateral speed of the rear axle, along y [m/s]; nullopt: no slip. Only for plants that can
  /// slip.
  std::optional<double> lateral_speed{};
  std::optional<double> yaw_rate{};  ///< Yaw rate [rad/s]; none: no slip.
};

/// The tyre model of the MuJoCo plant.
enum class TyreLaw {
  /// The Magic Formula if the car's file has its coefficients, else contacts.
  kAuto,
  kContact,  ///< MuJoCo's friction cone, with negligible slip below the friction limit.
  /// Magic Formula: forces grow with slip (vehicle/magic_formula.h). Contacts only carry the load.
  kMagicFormula,
};

/// How the commanded steering angle reaches the road wheels.
enum class SteeringInput {
  kActuator,    ///< Through the car's actuator, within its rate and angle limits.
  kPrescribed,  ///< Exactly and immediately, for validation.
};

}  // namespace trackbed

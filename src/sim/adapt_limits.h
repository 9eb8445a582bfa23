#pragma once

#include <array>
#include <string>

#include "src/sim/adapt_find.h"

namespace trackbed::adapt {

/// Limits of steering, drive, brakes and tyres of the proposed vehicle.
struct FoundLimits {
  double friction = 0.0;        ///< Sliding friction coefficient of tyres on the ground.
  double steering_limit = 0.0;  ///< Largest steering angle of the bicycle model [rad]; 0 with
                                ///< differential drive.
  double steering_rate = 0.0;   ///< Largest rate of the steering angle of the bicycle model
                                ///< [rad/s].
  double drive_torque = 0.0;    ///< Largest torque on all driven wheels together [N m].
  double wheel_speed = 0.0;     ///< Largest wheel speed [rad/s]; differential drive only.
  /// Whether each wheel is driven, in the order of FoundVehicle::wheels.
  std::array<bool, 4> driven{};
};

/// Mass, center of gravity and inertia of a group of bodies, in the vehicle frame V.
struct MassSum {
  double mass = 0.0;                ///< [kg]
  Vector center = Vector::Zero();   ///< Center of gravity [m].
  Matrix inertia = Matrix::Zero();  ///< Inertia about the center of gravity [kg m^2].

  /// Adds the mass properties of the bodies in `other`. If `sign` is -1, removes these bodies,
  /// which must be part of this group.
  void Add(const MassSum& other, double sign = 1.0);
};

/// Returns the mass properties of one body of the model.
MassSum MassOfBody(const FoundModel& found, const FoundVehicle& vehicle, int body);

/// Determines the vehicle's limits from joint ranges, couplings and actuators of the model. Throws
/// InputError, with a question and the option that answers it, if the model does not limit the
/// steering.
FoundLimits FindLimits(const FoundModel& found, const FoundVehicle& vehicle, double mass,
                       const AdaptOptions& options, Findings& findings);

}  // namespace trackbed::adapt

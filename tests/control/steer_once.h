#pragma once

#include "tests/vehicle/reference_car.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// Returns the first steering angle of a controller for a reference car at the given pose and speed
/// on a path without a speed profile, at the station 0.
inline double SteerOnce(const ControllerOptions& options, const Path& path, const Pose2& pose,
                        double speed) {
  const VehicleParams car = ReferenceCar();
  const Reference reference{path, {}};
  VehicleState state;
  state.pose = pose;
  state.speed = speed;
  return MakeSteeringController(options)->Steer({.vehicle = car,
                                                 .reference = reference,
                                                 .schedule = {},
                                                 .state = state,
                                                 .station = 0.0,
                                                 .period = 0.02});
}

}  // namespace trackbed

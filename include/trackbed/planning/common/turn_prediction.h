#pragma once

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// The smallest error that the limited steering rate causes in a turn of an open-loop run.
namespace trackbed {

/// An isolated turn: the wheels are straight before it, and reach their angle by its middle.
struct IsolatedTurn {
  int waypoint = 0;       ///< the corner's index in the route
  double from = 0.0;      ///< station where the wheels begin to turn [m]
  double middle = 0.0;    ///< station of the middle of the arc [m]
  double steering = 0.0;  ///< of the arc, signed [rad]
  double speed = 0.0;     ///< at which it is taken [m/s]
};

/// The error of a car at the middle of a turn: its pose relative to where its wheels began to turn,
/// compared with the path's pose relative to the same place.
struct TurnError {
  double heading_deficit = 0.0;  ///< heading of the path minus heading of the car [rad]
  double lateral_offset = 0.0;   ///< of the car from the path, positive to the left [m]
};

/// The error of a car that drives from `X_W_from` to `X_W_middle`, while the path runs from its
/// station `from` to `middle`.
TurnError ErrorInTurn(const Path& path, const IsolatedTurn& turn, const Pose2& X_W_from,
                      const Pose2& X_W_middle);

/// The exact TurnError of the rate-limited kinematic car: a ramp that starts at `from`, then the
/// arc. With S = v delta/omega and the wheels `lag` seconds behind their actuator, the heading
/// deficit is kappa S/2 - (v/(L omega)) (-ln cos delta) + kappa v lag for a ramp centered on the
/// tangent point.
TurnError PredictTurn(const VehicleParams& vehicle, const Path& path, const IsolatedTurn& turn,
                      double lag);

}  // namespace trackbed

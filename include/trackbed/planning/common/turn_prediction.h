#pragma once

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// The smallest error that the limited steering rate causes in a turn of an open-loop run.
namespace trackbed {

/// An isolated turn: the wheels are straight before it, and reach their angle by its middle.
struct IsolatedTurn {
  int waypoint = 0;       ///< Index of the corner in the route.
  double from = 0.0;      ///< Station at which the wheels begin to turn [m].
  double middle = 0.0;    ///< Station of the middle of the arc [m].
  double steering = 0.0;  ///< Steering on the arc, signed [rad].
  double speed = 0.0;     ///< Speed in the turn [m/s].
};

/// The error of a car at the middle of a turn. The car's pose relative to the point where its
/// wheels began to turn is compared with that of the path.
struct TurnError {
  double heading_deficit = 0.0;  ///< Heading of the path minus heading of the car [rad].
  double lateral_offset = 0.0;   ///< Offset of the car from the path, positive to the left [m].
};

/// The error of a car that drives from `X_W_from` to `X_W_middle`, while the path runs from its
/// station `from` to `middle`.
TurnError ErrorInTurn(const Path& path, const IsolatedTurn& turn, const Pose2& X_W_from,
                      const Pose2& X_W_middle);

/// The exact TurnError of the rate-limited kinematic car, which steers a ramp that starts at
/// `from`, then the arc. S = v delta/omega, and the wheels follow their actuator after `lag`
/// seconds. For a ramp centered on the tangent point, the heading deficit is kappa S/2 - (v/(L
/// omega)) (-ln cos delta) + kappa v lag.
TurnError PredictTurn(const VehicleParams& vehicle, const Path& path, const IsolatedTurn& turn,
                      double lag);

}  // namespace trackbed

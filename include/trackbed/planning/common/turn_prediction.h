#pragma once

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Predicts the smallest error that the limited steering rate causes in a turn of an open-loop run.
namespace trackbed {

/// An isolated turn: the wheels are straight before the turn, and reach the steering angle of the
/// arc by the middle of the turn.
struct IsolatedTurn {
  int waypoint = 0;       ///< Index of the corner in the route.
  double from = 0.0;      ///< Station at which the wheels begin to turn [m].
  double middle = 0.0;    ///< Station of the middle of the arc [m].
  double steering = 0.0;  ///< Steering on the arc, signed [rad].
  double speed = 0.0;     ///< Speed in the turn [m/s].
};

/// The error of a car at the middle of a turn. The error compares the motions of car and path since
/// the point at which the wheels began to turn.
struct TurnError {
  double heading_deficit = 0.0;  ///< Heading of the path minus heading of the car [rad].
  double lateral_offset = 0.0;   ///< Offset of the car from the path, positive to the left [m].
};

/// Returns the error of a car that drives from pose `X_W_from` to pose `X_W_middle`, while the path
/// leads from the station `turn.from` to the station `turn.middle`.
TurnError ErrorInTurn(const Path& path, const IsolatedTurn& turn, const Pose2& X_W_from,
                      const Pose2& X_W_middle);

/// Computes the exact error of a kinematic car with rate-limited steering. The actuator begins to
/// turn the wheels at the station `turn.from`, and then holds the steering angle delta of the arc.
/// The wheels follow the actuator with a delay of `lag` [s]. For a ramp of the length S = v
/// delta/omega, centered on the tangent point, the heading deficit is kappa S/2 - (v/(L omega))
/// (-ln cos delta) + kappa v lag.
TurnError PredictTurn(const VehicleParams& vehicle, const Path& path, const IsolatedTurn& turn,
                      double lag);

}  // namespace trackbed

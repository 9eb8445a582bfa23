#pragma once

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Predicts the smallest deviation from the path that the limited steering rate causes in a turn of
/// an open-loop run.
namespace trackbed {

/// An isolated turn: the wheels are straight before the turn, and reach the steering angle of the
/// arc by the middle of the turn.
struct IsolatedTurn {
  int waypoint = 0;       ///< Index of the turn's waypoint in the route.
  double from = 0.0;      ///< Station at which the wheels begin to turn [m].
  double middle = 0.0;    ///< Station of the middle of the turn's arc [m].
  double steering = 0.0;  ///< Steering angle on the turn's arc, positive to the left [rad].
  double speed = 0.0;     ///< Speed of the car in the turn [m/s].
};

/// Heading and lateral deviation of a car from the path at the middle of a turn, if the car was
/// exactly on the path when its wheels began to turn.
struct TurnError {
  double heading_deficit = 0.0;  ///< Heading of the path minus heading of the car [rad].
  double lateral_offset = 0.0;   ///< Offset of the car from the path, positive to the left [m].
};

/// Compares the motion of a car from pose `X_W_from` to pose `X_W_middle` with the course of the
/// path from the station `turn.from` to `turn.middle`. Returns the car's deviation from the path in
/// heading and lateral position.
TurnError ErrorInTurn(const Path& path, const IsolatedTurn& turn, const Pose2& X_W_from,
                      const Pose2& X_W_middle);

/// Computes the exact deviation of a kinematic car with rate-limited steering from the path at the
/// middle of a turn. The steering actuator begins to move at the station `turn.from`, and then
/// holds the steering angle delta of the arc. The wheels follow the steering actuator with a delay
/// of `lag` [s]. At the speed v, with the steering rate omega, a steering ramp to the angle delta
/// has the length S = v delta/omega. If the ramp is centered on the start of an arc of curvature
/// kappa, the heading deficit is kappa S/2 - (v/(L omega)) (-ln cos delta) + kappa v lag, with the
/// wheelbase L.
TurnError PredictTurn(const VehicleParams& vehicle, const Path& path, const IsolatedTurn& turn,
                      double lag);

}  // namespace trackbed

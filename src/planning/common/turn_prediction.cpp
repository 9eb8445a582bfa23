#include "trackbed/planning/common/turn_prediction.h"

#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

TurnError ErrorInTurn(const Path& path, const IsolatedTurn& turn, const Pose2& X_W_from,
                      const Pose2& X_W_middle) {
  const Pose2 planned_from = path.At(turn.from).pose;
  const Pose2 planned_middle = path.At(turn.middle).pose;
  // Compose the car's displacement in the turn with the turn's planned start pose.
  const Vec2 way = ToLocal(X_W_from, X_W_middle.position());
  const Vec2 offset = ToLocal(planned_middle, ToWorld(planned_from, way));
  return {(planned_middle.yaw - planned_from.yaw) - (X_W_middle.yaw - X_W_from.yaw), offset.y()};
}

TurnError PredictTurn(const VehicleParams& vehicle, const Path& path, const IsolatedTurn& turn,
                      double lag) {
  // Distance by which a steering lag delays the beginning of the turn [m].
  const double late = turn.speed * lag;
  const double ramp = SteeringDistance(vehicle, turn.steering, turn.speed);
  const double held = turn.middle - turn.from - ramp - late;
  const Pose2 begun{late, 0.0, 0.0};
  const Pose2 turned = Compose(begun, RampPose(vehicle, turn.steering, turn.speed));
  const double curvature = CurvatureForSteering(vehicle, turn.steering);
  return ErrorInTurn(path, turn, {}, MoveOnArc(turned, held, held * curvature));
}

}  // namespace trackbed

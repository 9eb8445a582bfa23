#include "trackbed/geometry/pose.h"

#include <cmath>

namespace trackbed {

Vec2 Direction(double yaw) {
  return {std::cos(yaw), std::sin(yaw)};
}

Vec2 ToWorld(const Pose2& X_WA, const Vec2& p_AQ) {
  const Vec2 ahead = Direction(X_WA.yaw);
  return X_WA.position() + p_AQ.x() * ahead + p_AQ.y() * LeftNormal(ahead);
}

Vec2 ToLocal(const Pose2& X_WA, const Vec2& p_WQ) {
  const Vec2 ahead = Direction(X_WA.yaw);
  const Vec2 offset = p_WQ - X_WA.position();
  return {ahead.dot(offset), Cross(ahead, offset)};
}

Pose2 Compose(const Pose2& X_WA, const Pose2& X_AB) {
  const Vec2 p_WB = ToWorld(X_WA, X_AB.position());
  return {p_WB.x(), p_WB.y(), X_WA.yaw + X_AB.yaw};
}

Pose2 MoveOnArc(const Pose2& start, double distance, double turn, double slip) {
  // The chord of an arc has the length distance * sin(turn/2)/(turn/2) and the mean direction of
  // the arc.
  const double half = 0.5 * turn;
  // For angles below 1e-4, the Taylor series is exact to double precision, because the next term of
  // the series is below 1e-18.
  const double ratio = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const Vec2 end = start.position() + distance * ratio * Direction(start.yaw + slip + half);
  return {end.x(), end.y(), start.yaw + turn};
}

}  // namespace trackbed

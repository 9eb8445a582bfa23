#pragma once

#include <Eigen/Core>

namespace trackbed {

/// A point or direction in the plane [m]; world axes are x east, y north.
using Vec2 = Eigen::Vector2d;

/// Position [m] and heading [rad, counter-clockwise from x] of a planar frame.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  [[nodiscard]] Vec2 position() const { return {x, y}; }

  bool operator==(const Pose2&) const = default;
};

/// The unit vector that points along `yaw`.
Vec2 Direction(double yaw);

/// The vector `vector` turned left by 90 degrees.
inline Vec2 LeftNormal(const Vec2& vector) {
  return {-vector.y(), vector.x()};
}

/// The z component of the cross product a x b: positive if b points to the left of a.
inline double Cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Returns X_WB = X_WA * X_AB, the pose of B in W, from the pose of A in W and the pose of B in A.
/// The yaws are added without wrapping, so that a heading can be followed over several turns.
Pose2 Compose(const Pose2& X_WA, const Pose2& X_AB);

/// Returns the world coordinates p_WQ of a point whose coordinates in the frame A are p_AQ.
Vec2 ToWorld(const Pose2& X_WA, const Vec2& p_AQ);

/// Returns the coordinates p_AQ in the frame A of a point whose world coordinates are p_WQ.
Vec2 ToLocal(const Pose2& X_WA, const Vec2& p_WQ);

/// Returns the pose of a frame that has moved by `distance` [m, negative backwards] along its x
/// axis while turning by `turn` [rad] at a constant rate. The result is exact for lines and arcs.
/// `slip` [rad] is the constant angle from the x axis to the direction of motion (the sideslip
/// angle at the moving point).
Pose2 MoveOnArc(const Pose2& start, double distance, double turn, double slip = 0.0);

}  // namespace trackbed

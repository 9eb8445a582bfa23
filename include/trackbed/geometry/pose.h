#pragma once

#include <Eigen/Core>

namespace trackbed {

/// A point or direction in the plane [m]; the world's x axis points east and the y axis points
/// north.
using Vec2 = Eigen::Vector2d;

/// Position [m] and heading [rad] of a coordinate frame in the plane; the heading counts
/// counter-clockwise from the x axis.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  [[nodiscard]] Vec2 position() const { return {x, y}; }

  bool operator==(const Pose2&) const = default;
};

/// Returns the unit vector in the direction `yaw`.
Vec2 Direction(double yaw);

/// Returns `vector` turned left by 90 degrees.
inline Vec2 LeftNormal(const Vec2& vector) {
  return {-vector.y(), vector.x()};
}

/// Returns the z component of the cross product a x b, which is positive if b points to the left of
/// a.
inline double Cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Computes the pose X_WB = X_WA * X_AB of a frame B in the world W, from the pose X_WA of a frame
/// A in W and the pose X_AB of B in A. The yaws are added without wrapping, so the heading is
/// continuous over several full turns.
Pose2 Compose(const Pose2& X_WA, const Pose2& X_AB);

/// Converts the coordinates p_AQ of a point in the frame A to the point's world coordinates p_WQ.
Vec2 ToWorld(const Pose2& X_WA, const Vec2& p_AQ);

/// Converts the world coordinates p_WQ of a point to the point's coordinates p_AQ in the frame A.
Vec2 ToLocal(const Pose2& X_WA, const Vec2& p_WQ);

/// Returns the pose of a frame after a motion along a line or an arc, exact except for rounding
/// errors. The frame moves by `distance` [m, negative backwards] along its own x axis while it
/// turns by `turn` [rad] at a constant rate. `slip` [rad] is the constant angle from the x axis to
/// the direction of motion (the sideslip angle at the moving point).
Pose2 MoveOnArc(const Pose2& start, double distance, double turn, double slip = 0.0);

}  // namespace trackbed

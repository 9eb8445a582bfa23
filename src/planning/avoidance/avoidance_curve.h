#pragma once

#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/bezier.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"

/// Functions that fit a curve past obstacles to a polyline, and check a curve.
namespace trackbed::avoidance {

/// Coordinate frame in which the tree search and the curve are computed. The origin is the curve's
/// start, and right turns are mirrored to left turns. Problems that differ only by a translation,
/// rotation or reflection have the same coordinates in the MirrorFrame.
struct MirrorFrame {
  Pose2 pose;
  double side = 1.0;  ///< Factor of the y axis: with -1, the y axis points to the right.

  [[nodiscard]] Vec2 In(const Vec2& p) const {
    const Vec2 local = ToLocal(pose, p);
    return {local.x(), side * local.y()};
  }
  [[nodiscard]] Vec2 Out(const Vec2& p) const { return ToWorld(pose, {p.x(), side * p.y()}); }
  [[nodiscard]] double In(double yaw) const { return side * (yaw - pose.yaw); }
  [[nodiscard]] OrientedBox In(const OrientedBox& box) const {
    const Vec2 center = In(box.center.position());
    return {{center.x(), center.y(), In(box.center.yaw)}, box.length, box.width};
  }
};

/// Boundary condition at the start or end of a curve.
struct CurveEnd {
  Pose2 pose;
  double curvature = 0.0;  ///< [1/m]
};

/// The side on which the car is to pass an obstacle.
struct PassageConstraint {
  Pose2 frame;  ///< Frame at the obstacle, whose x axis points along the path.
  /// Side on which the car passes the obstacle: +1 to the left of the frame's origin, -1 to the
  /// right.
  double side = 1.0;
};

struct CurveProblem {
  VehicleParams vehicle;
  CurveEnd start;
  CurveEnd end;
  PassageConstraint passage;
  double mirror = 1.0;  ///< Factor of the y axis; with -1, the problem is mirrored (see
                        ///< MirrorFrame).
  std::vector<OrientedBox> obstacles;
  double safe_distance = 0.0;  ///< Safe distance SD that the curve must keep from obstacles [m].
  double steering_rate = 0.0;  ///< Maximum steering rate on the curve [rad/s].
  double lateral_acceleration = 0.0;  ///< Maximum lateral acceleration on the curve [m/s^2].
  double start_speed = 0.0;           ///< Speed of the car at the start of the curve [m/s].
  /// Speed of the car on the curve; a faster car brakes to this speed, a slower car is assumed to
  /// have it at once [m/s].
  double speed = 0.0;
  double deceleration = 0.0;  ///< Deceleration with which the car brakes to `speed` [m/s^2].

  [[nodiscard]] MirrorFrame Frame() const { return {start.pose, mirror}; }
  /// Returns the largest possible speed of the car after `distance` on the curve [m/s].
  [[nodiscard]] double SpeedAt(double distance) const;
};

/// Length and clearance of a curve, and the largest steering and acceleration that the curve
/// requires.
struct CurveCheck {
  double length = 0.0;  ///< Length of the curve [m].
  /// Smallest distance between footprint and obstacles; infinite without obstacles [m].
  double clearance = 0.0;
  double steering = 0.0;       ///< Largest magnitude of the steering angle on the curve [rad].
  double steering_rate = 0.0;  ///< Largest magnitude of the steering rate on the curve [rad/s].
  /// Largest magnitude of the lateral acceleration on the curve [m/s^2].
  double lateral_acceleration = 0.0;

  [[nodiscard]] bool Keeps(const CurveProblem& problem) const;
};

/// Evaluates the curve at points every 0.05 m.
CurveCheck Check(const CurveProblem& problem, const BezierCurve& curve);

/// Fits a degree-7 curve by least squares to a polyline from the start to the end. The end
/// conditions of the problem determine six control points of the curve; the fit determines P_3 and
/// P_4. The end lengths |P_0 P_1|, |P_1 P_2|, |P_5 P_6| and |P_6 P_7| are a seventh of the
/// polyline's length.
BezierCurve Fit(const CurveProblem& problem, const std::vector<Vec2>& polyline);

/// Returns the y coordinate at which the line between two points on either side of the y axis
/// crosses the axis.
double CrossingY(const Vec2& a, const Vec2& b);

/// Returns whether a polyline passes an obstacle on the required side. A polyline that passes on
/// the required side crosses the lateral axis of the obstacle's frame on this side an odd number of
/// times.
bool GoesThrough(const PassageConstraint& passage, const std::vector<Vec2>& polyline);

}  // namespace trackbed::avoidance

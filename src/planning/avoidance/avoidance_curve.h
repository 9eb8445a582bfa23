#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/optimize/search.h"
#include "trackbed/path/bezier.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"

/// Curves past obstacles: the first guess, its check and its repair.
namespace trackbed::avoidance {

/// Frame of the tree search and of the curve: at the curve's start, mirrored for a right turn.
/// Moved or mirrored problems then have the same coordinates.
struct MirrorFrame {
  Pose2 pose;
  double side = 1.0;  ///< -1: y points to the right

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

/// The side on which an obstacle is to be passed.
struct PassageConstraint {
  Pose2 frame;        ///< at the obstacle, along the path past it
  double side = 1.0;  ///< +1: pass to the left of the frame's origin, -1: to the right
};

struct CurveProblem {
  VehicleParams vehicle;
  CurveEnd start;
  CurveEnd end;
  PassageConstraint passage;
  double mirror = 1.0;  ///< -1: mirrored (see MirrorFrame)
  std::vector<OrientedBox> obstacles;
  double safe_distance = 0.0;         ///< SD [m]
  double steering_rate = 0.0;         ///< available to the curve [rad/s]
  double lateral_acceleration = 0.0;  ///< limit [m/s^2]
  double start_speed = 0.0;           ///< [m/s]
  double speed = 0.0;                 ///< to brake to, or to accelerate to immediately [m/s]
  double deceleration = 0.0;          ///< with which the car brakes to `speed` [m/s^2]

  [[nodiscard]] MirrorFrame Frame() const { return {start.pose, mirror}; }
  /// Largest speed after `distance` [m/s].
  [[nodiscard]] double SpeedAt(double distance) const;
};

/// Largest demands of a curve on the car, and its clearance.
struct CurveCheck {
  double length = 0.0;                ///< [m]
  double clearance = 0.0;             ///< of the footprint; infinite without obstacles [m]
  double steering = 0.0;              ///< largest magnitude [rad]
  double steering_rate = 0.0;         ///< largest magnitude [rad/s]
  double lateral_acceleration = 0.0;  ///< largest magnitude [m/s^2]

  [[nodiscard]] bool Keeps(const CurveProblem& problem) const;
};

/// Checks every 0.05 m.
CurveCheck Check(const CurveProblem& problem, const BezierCurve& curve);

/// Least-squares fit of a degree-7 curve with the problem's end conditions to a polyline from start
/// to end. P_3 and P_4 are fitted; the end lengths |P_0 P_1|, |P_1 P_2|, |P_5 P_6| and |P_6 P_7|
/// are a seventh of the polyline's length.
BezierCurve Fit(const CurveProblem& problem, const std::vector<Vec2>& polyline);

struct Repair {
  BezierCurve curve;
  CurveCheck check;
  SearchResult search;
};

/// Whether a polyline passes on the required side: it crosses that side an odd number of times.
bool GoesThrough(const PassageConstraint& passage, const std::vector<Vec2>& polyline);

/// Moves P_3, P_4 and the end lengths, starting at `guess`, to minimize the curvature variation,
/// the integral of (dkappa/ds)^2 ds, of a curve that passes on the required side and keeps the safe
/// distance and the limits. None if the search finds no such curve.
std::optional<Repair> RepairCurve(const CurveProblem& problem, const BezierCurve& guess,
                                  const SearchOptions& search, std::uint64_t seed);

}  // namespace trackbed::avoidance

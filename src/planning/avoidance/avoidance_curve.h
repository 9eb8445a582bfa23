#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/optimize/search.h"
#include "trackbed/path/bezier.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"

/// One curve past obstacles: from a first guess to one that can be driven safely.
namespace trackbed::avoidance {

/// The frame in which ways and curves are looked for: that of the curve's start, seen in a mirror
/// where the turn leads to the right, so that a moved or mirrored problem is the same one.
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

/// Where a curve begins or ends.
struct CurveEnd {
  Pose2 pose;
  double curvature = 0.0;  ///< [1/m]
};

/// The side on which an obstacle is to be passed.
struct PassageConstraint {
  Pose2 frame;        ///< at the obstacle, along the way past it
  double side = 1.0;  ///< +1: across the frame's y axis on the left, -1: on the right
};

struct CurveProblem {
  VehicleParams vehicle;
  CurveEnd start;
  CurveEnd end;
  PassageConstraint passage;
  double mirror = 1.0;  ///< -1: looked at in a mirror (see MirrorFrame)
  std::vector<OrientedBox> obstacles;
  double safe_distance = 0.0;         ///< SD [m]
  double steering_rate = 0.0;         ///< that the curve may ask for [rad/s]
  double lateral_acceleration = 0.0;  ///< likewise [m/s^2]
  double start_speed = 0.0;           ///< [m/s]
  double speed = 0.0;                 ///< to come down to, or to go up to at once [m/s]
  double deceleration = 0.0;          ///< at which [m/s^2]

  [[nodiscard]] MirrorFrame Frame() const { return {start.pose, mirror}; }
  /// Speed after `distance` [m/s], at most.
  [[nodiscard]] double SpeedAt(double distance) const;
};

/// What a curve asks of the car, and how close it comes.
struct CurveCheck {
  double length = 0.0;                ///< [m]
  double clearance = 0.0;             ///< of the footprint; infinite without obstacles [m]
  double steering = 0.0;              ///< largest magnitude [rad]
  double steering_rate = 0.0;         ///< likewise [rad/s]
  double lateral_acceleration = 0.0;  ///< likewise [m/s^2]

  [[nodiscard]] bool Keeps(const CurveProblem& problem) const;
};

/// Looks every 0.05 m.
CurveCheck Check(const CurveProblem& problem, const BezierCurve& curve);

/// The degree-7 curve with the problem's end conditions that comes closest to a polyline from start
/// to end, in the sense of least squares: P_3 and P_4 are fitted, the ends are a seventh of its
/// length apart.
BezierCurve Fit(const CurveProblem& problem, const std::vector<Vec2>& polyline);

struct Repair {
  BezierCurve curve;
  CurveCheck check;
  SearchResult search;
};

/// Whether a polyline goes through the passage: an odd number of times across its side.
bool GoesThrough(const PassageConstraint& passage, const std::vector<Vec2>& polyline);

/// Moves P_3, P_4 and the end lengths from those of `guess` for the least curvature variation,
/// the integral of (dkappa/ds)^2 ds, that goes through the passage and keeps distance and limits.
/// None when the search found no such curve.
std::optional<Repair> RepairCurve(const CurveProblem& problem, const BezierCurve& guess,
                                  const SearchOptions& search, std::uint64_t seed);

}  // namespace trackbed::avoidance

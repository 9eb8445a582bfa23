#pragma once

#include <optional>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/frenet/polynomial.h"

/// Describes motions along a path by polynomials in the path's Frenet frame, and converts motions
/// to references for controllers.
namespace trackbed {

/// A piece of a motion, given by the station s(t) and by the offset d as a function of the time or
/// of the station.
struct FrenetPiece {
  double duration = 0.0;  ///< Duration of the piece of the motion [s].
  /// Station s [m] as a function of the time since the start of the motion's piece [s].
  Polynomial s;
  /// Offset d [m] as a function of the time since the start of the motion's piece [s], or of the
  /// station s - s(0) since this start [m].
  Polynomial d;
  /// Whether the offset d is a function of the station s - s(0), not of time.
  bool over_station = false;

  /// Returns the state of the car at the time `t` [s] after the start of the piece. If the offset d
  /// is a function of time, the derivatives d' = d_t/s_t and d'' by the station are not finite
  /// while the car stands (s_t = 0).
  [[nodiscard]] FrenetState At(double t) const;

  bool operator==(const FrenetPiece&) const = default;
};

/// A motion that consists of consecutive pieces.
struct FrenetMotion {
  std::vector<FrenetPiece> pieces;

  [[nodiscard]] double duration() const;
  /// Returns the state of the car at the time `t` [s] after the start of the motion. Values of `t`
  /// outside of the motion are clamped to its start or end. Throws InternalError if the motion has
  /// no pieces.
  [[nodiscard]] FrenetState At(double t) const;

  bool operator==(const FrenetMotion&) const = default;
};

/// A point of a motion along a path.
struct TrajectoryPoint {
  double t = 0.0;         ///< Time since the start of the motion [s].
  double distance = 0.0;  ///< Distance driven since the start of the motion [m].
  FrenetState frenet;
  MotionState motion;

  bool operator==(const TrajectoryPoint&) const = default;
};

/// Samples a motion at the ends of its pieces and evenly between these ends, at most `time_step`
/// [s] and about `spacing` [m] apart. The driven distance is integrated with an error of fourth
/// order. Returns nullopt if the Frenet frame is undefined (see FromFrenet), or if the offset d is
/// a function of time while the car does not move forward.
std::optional<std::vector<TrajectoryPoint>> SampleMotion(const Path& path,
                                                         const FrenetMotion& motion,
                                                         double time_step, double spacing);

/// Makes the reference of a controller from the points of a motion. The reference path passes
/// through the motion's points with their headings and curvatures; the speed profile is a function
/// of the station on this path. If the points are 0.1 m apart and the motion follows a path with
/// smooth curvature, the reference path stays within 1e-5 m and 1e-5 rad of the motion. A point
/// closer than a millimeter to the previous point is left out; such points occur when a car starts
/// or stops. If the car does not move, the reference path has the length 0. Throws InternalError if
/// `points` is empty.
Reference ToReference(const std::vector<TrajectoryPoint>& points);

}  // namespace trackbed

#pragma once

#include <optional>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/frenet/polynomial.h"

/// Motions along a path as polynomials in its Frenet frame, and their conversion to references for
/// controllers.
namespace trackbed {

/// A piece of a motion: s(t), and d over the time or over the station.
struct FrenetPiece {
  double duration = 0.0;      ///< Duration [s].
  Polynomial s;               ///< Station over the time since the start of the piece.
  Polynomial d;               ///< Offset over the same time, or over s - s(0).
  bool over_station = false;  ///< Whether d is a function of s - s(0).

  /// The state `t` [s] after the start of the piece. If d is a function of time, d' = d_t/s_t and
  /// d'' are not finite while s_t = 0.
  [[nodiscard]] FrenetState At(double t) const;

  bool operator==(const FrenetPiece&) const = default;
};

/// A motion of consecutive pieces.
struct FrenetMotion {
  std::vector<FrenetPiece> pieces;

  [[nodiscard]] double duration() const;
  /// The state `t` [s] after the start, clamped to the start and the end of the motion.
  /// InternalError without pieces.
  [[nodiscard]] FrenetState At(double t) const;

  bool operator==(const FrenetMotion&) const = default;
};

/// A point of a motion along a path.
struct TrajectoryPoint {
  double t = 0.0;         ///< Time since the start [s].
  double distance = 0.0;  ///< Distance driven since the start [m].
  FrenetState frenet;
  MotionState motion;

  bool operator==(const TrajectoryPoint&) const = default;
};

/// Samples the motion at the ends of its pieces and evenly between them, at most `time_step` [s]
/// and about `spacing` [m] apart. The distance is integrated to fourth order. Nullopt if the frame
/// is undefined (see FromFrenet), or if d(t) has no forward motion.
std::optional<std::vector<TrajectoryPoint>> SampleMotion(const Path& path,
                                                         const FrenetMotion& motion,
                                                         double time_step, double spacing);

/// Makes the reference of a controller from points. The path passes through the points with their
/// headings and curvatures; the speed profile is over its stations. Between points 0.1 m apart, the
/// path stays within 1e-5 m and 1e-5 rad of a motion over a path with smooth curvature. Points
/// closer than a millimeter to the previous point, as when a car starts or stops, are left out. A
/// car that does not move gets a path of length 0. InternalError without points.
Reference ToReference(const std::vector<TrajectoryPoint>& points);

}  // namespace trackbed

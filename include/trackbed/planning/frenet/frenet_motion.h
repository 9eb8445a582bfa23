#pragma once

#include <optional>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/frenet/polynomial.h"

/// Motions along a path, described by polynomials in the path's Frenet frame. Converts motions to
/// references for controllers.
namespace trackbed {

/// A piece of a motion: the station s(t), and the offset d as a function of the time or of the
/// station.
struct FrenetPiece {
  double duration = 0.0;  ///< Duration [s].
  Polynomial s;           ///< Station over the time since the start of the piece.
  Polynomial d;           ///< Offset over the time since the start of the piece, or over s - s(0).
  bool over_station = false;  ///< Whether d is a function of s - s(0).

  /// Returns the state `t` [s] after the start of the piece. If d is a function of time, d' =
  /// d_t/s_t and d'' are not finite while s_t = 0.
  [[nodiscard]] FrenetState At(double t) const;

  bool operator==(const FrenetPiece&) const = default;
};

/// A motion of consecutive pieces.
struct FrenetMotion {
  std::vector<FrenetPiece> pieces;

  [[nodiscard]] double duration() const;
  /// Returns the state `t` [s] after the start of the motion. `t` is clamped to the duration of the
  /// motion. Throws InternalError if the motion has no pieces.
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
/// and about `spacing` [m] apart. The driven distance is integrated to fourth order. Returns
/// nullopt if the Frenet frame is undefined (see FromFrenet), or if d is a function of time and the
/// car does not move forward.
std::optional<std::vector<TrajectoryPoint>> SampleMotion(const Path& path,
                                                         const FrenetMotion& motion,
                                                         double time_step, double spacing);

/// Makes the reference of a controller from the points of a motion. The path passes through the
/// points with their headings and curvatures; the speed profile is a function of the path's
/// station. Between points 0.1 m apart, the path stays within 1e-5 m and 1e-5 rad of a motion over
/// a path with smooth curvature. A point closer than a millimeter to the previous point is left
/// out; such points occur when a car starts or stops. If the car does not move, the path has the
/// length 0. Throws InternalError if there are no points.
Reference ToReference(const std::vector<TrajectoryPoint>& points);

}  // namespace trackbed

#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Position of a car relative to its path, for controller and log.
namespace trackbed {

/// Returns the range of stations in which to search for the projection of a car that moved by
/// `moved` [m] since it was at `station`. At both ends, the search range has a margin that is
/// larger than the distance by which lateral kicks move the car in a control period. The margin of
/// the search range is shorter than any turn of the car, so that the projection stays on the same
/// branch of a path that crosses itself.
inline Stations StationsAround(const VehicleParams& vehicle, double station, double moved) {
  constexpr double kMargin = 0.75;  // margin of the search as a fraction of the wheelbase
  const double margin = kMargin * vehicle.wheelbase;
  return {station - margin, station + moved + margin};
}

/// Computes the signed distance and the heading error of a car relative to the path without
/// extensions; left is positive. The argument `extended` is the car's projection onto the path with
/// straight extensions at both ends, as controllers use it. Up to `overrun` [m] beyond the path's
/// end, the lateral distance is measured from the straight extension, because a car may stop
/// slightly too late. Before the path's start and farther beyond its end, the car's lateral
/// distance is measured from the path's end point.
inline Projection DistanceFromPath(const Path& path, const Projection& extended, const Pose2& pose,
                                   double overrun) {
  Projection at = extended;
  if (extended.s > path.length() + overrun || extended.s < 0.0) {
    at.s = std::clamp(extended.s, 0.0, path.length());
  }
  const PathPoint nearest = path.At(at.s);
  const Vec2 offset = ToLocal(nearest.pose, pose.position());
  at.cross_track = std::copysign(offset.norm(), offset.y());
  at.heading_error = AngleDifference(pose.yaw, nearest.pose.yaw);
  return at;
}

}  // namespace trackbed

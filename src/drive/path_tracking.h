#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Position of a car relative to its path, for controller and log.
namespace trackbed {

/// Range of stations for a car that moved by `moved` [m] since it was at `station`. The margin on
/// both sides exceeds the lateral kicks of a control period. The margin is shorter than any turn of
/// the car, so that the projection stays on the same branch of the path.
inline Stations StationsAround(const VehicleParams& vehicle, double station, double moved) {
  constexpr double kMargin = 0.75;  // of the wheelbase
  const double margin = kMargin * vehicle.wheelbase;
  return {station - margin, station + moved + margin};
}

/// Signed distance of a car from the path without its extensions, positive to the left. `extended`
/// is the projection onto the path with straight extensions at both ends, which controllers use. Up
/// to `overrun` [m] beyond the path's end, the distance is measured from the extension. The
/// `overrun` allows for a car that stops slightly too late. Further beyond either end of the path,
/// the distance is measured from the end point.
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

#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Where a car is against its path: for its controller, and for the log.
namespace trackbed {

/// The stations among which a car must be that moved by `moved` [m] since it was at `station`: a
/// margin on both sides, more than it can be pushed in a control period and less than the way round
/// any turn it could make.
inline Stations StationsAround(const VehicleParams& vehicle, double station, double moved) {
  constexpr double kMargin = 0.75;  // of the wheelbase
  const double margin = kMargin * vehicle.wheelbase;
  return {station - margin, station + moved + margin};
}

/// How far a car is from the path as it is, which has a beginning and an end. `extended` is its
/// projection onto the path and the straight lines before and beyond it, by which controllers
/// steer. A car that comes to rest up to `overrun` [m] beyond the end is still compared with the
/// line that goes on there; anywhere else beyond either end, the distance is that from the end
/// point. The distance has the sign of the side, positive to the left.
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

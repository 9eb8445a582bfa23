#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/track/track.h"
#include "trackbed/vehicle/params.h"

/// Limits of the footprint on either side of a path, over its station: the edges of a track seen
/// from a line on it.
///
/// Symbols: those of path/frenet_frame.h; a point of the footprint has the station s and offset d
/// of the nearest point of the path.
namespace trackbed {

/// Immutable.
class RoadEdges {
 public:
  /// `widths` are at the stations 0, `spacing`, 2 `spacing`, ... of the path. A right width may be
  /// negative where both edges are to the left of the path, and vice versa. InternalError without
  /// widths, or unless the spacing is positive.
  RoadEdges(double spacing, std::vector<RoadWidths> widths);

  /// Linear between the stations; constant before the first and beyond the last one.
  [[nodiscard]] RoadWidths At(double s) const;

 private:
  double spacing_;
  std::vector<RoadWidths> widths_;
};

/// The largest distance of a footprint beyond the edges [m], negative within them, over five points
/// of each long side, from corner to corner. Approximates the path by its circle of curvature at
/// the rear axle: over the length of a car, the error is at most the path's sharpness times
/// length^3/6. Infinite at or beyond that circle's center. Cost: 0.3 us.
double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet);

/// The edges of a track seen from a path along it, for a footprint that keeps `distance` [m] from
/// them, or the smaller distance that it has on the path itself: a car on the path is always within
/// them. Where the path leaves the track, the car may leave it equally far. Beyond the path's end,
/// the edges keep their distance from the path at the end.
///
/// Guarantees: exact for the edges' polylines (Track::left_edge) at stations at most 0.5 m apart,
/// linear in between. Cost: 40 us per meter of path.
RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance);

}  // namespace trackbed

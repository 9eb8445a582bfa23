#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/track/track.h"
#include "trackbed/vehicle/params.h"

/// How far the footprint may reach to either side of a path, over its station: the edges of a track
/// seen from a line on it.
///
/// Symbols: those of path/frenet_frame.h; a point of the footprint is at station s and offset d of
/// the nearest point of the path.
namespace trackbed {

/// Immutable value.
class RoadEdges {
 public:
  /// `widths` at the stations 0, `spacing`, 2 `spacing`, ... of the path. A right width may be
  /// negative where both edges are to the left of the path, and vice versa. InternalError without
  /// widths or unless the spacing is positive.
  RoadEdges(double spacing, std::vector<RoadWidths> widths);

  /// Linear between the stations; before the first and beyond the last one theirs.
  [[nodiscard]] RoadWidths At(double s) const;

 private:
  double spacing_;
  std::vector<RoadWidths> widths_;
};

/// By how much a footprint reaches beyond the edges [m], negative within them: the largest over
/// five points of each of its long sides, from corner to corner. The path is taken to follow the
/// circle of its curvature at the rear axle: over the length of a car that is off by at most its
/// sharpness times length^3/6. Infinite at or beyond that circle's center. Cost: 0.3 us.
double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet);

/// The edges of a track seen from a path along it, for a footprint that keeps `distance` [m] from
/// them, or as much as it keeps on the path itself where that is less: a car on the path is always
/// within them. Where the path leaves the track, so may the car, as far and no farther. Beyond the
/// path's end the edges stay as far from it as they are there.
///
/// Guarantees: exact for the edges' polylines (Track::left_edge) at stations at most 0.5 m apart,
/// linear in between. Cost: 40 us a meter of path.
RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance);

}  // namespace trackbed

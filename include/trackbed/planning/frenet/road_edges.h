#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/track/track.h"
#include "trackbed/vehicle/params.h"

/// Limits of the footprint on either side of a path, over its station. The limits represent the
/// edges of a track, relative to a line on the track.
///
/// Symbols: those of path/frenet_frame.h; a point of the footprint has the station s and offset d
/// of the nearest point of the path.
namespace trackbed {

/// Edges on both sides of a path. Immutable.
class RoadEdges {
 public:
  /// The `widths` are given at the stations 0, `spacing`, 2 `spacing`, ... of the path. If both
  /// edges are to the left of the path, the right width is negative, and vice versa. InternalError
  /// without widths, or unless the spacing is positive.
  RoadEdges(double spacing, std::vector<RoadWidths> widths);

  /// The widths at a station, linear between the given stations; constant before the first and
  /// beyond the last one.
  [[nodiscard]] RoadWidths At(double s) const;

 private:
  double spacing_;
  std::vector<RoadWidths> widths_;
};

/// The largest distance of a footprint beyond the edges [m], negative if it is within the edges.
/// Tests five points of each long side, from corner to corner. Approximates the path by its circle
/// of curvature at the rear axle. Over the length of a car, the error is at most the path's
/// sharpness times length^3/6. Infinite at or beyond the center of that circle. Cost: 0.3 us.
double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet);

/// The edges of a track relative to a path along the track, for a footprint that keeps `distance`
/// [m] from the edges. If a car on the path is closer to an edge than `distance`, the limit is the
/// car's distance. A car on the path is therefore always within the limits, even where the path
/// leaves the track. Beyond the path's end, the edges keep the distance from the path that they
/// have at the end.
///
/// Guarantees: the result is exact for the polylines of the edges (Track::left_edge) at stations at
/// most 0.5 m apart, and linear in between. Cost: 40 us per meter of path.
RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance);

}  // namespace trackbed

#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/track/track.h"
#include "trackbed/vehicle/params.h"

/// Limits of the car's footprint on either side of a path, as functions of the path's station. The
/// limits represent the edges of a track, relative to a line on the track.
///
/// Symbols: as in path/frenet_frame.h; a point of the footprint has the station s and offset d of
/// the nearest point of the path.
namespace trackbed {

/// Edges on both sides of a path. The class is immutable.
class RoadEdges {
 public:
  /// The `widths` are given at the stations 0, `spacing`, 2 `spacing`, ... of the path. If both
  /// edges are to the left of the path, the right width is negative, and vice versa. Throws
  /// InternalError if there are no widths, or unless the spacing is positive.
  RoadEdges(double spacing, std::vector<RoadWidths> widths);

  /// Returns the widths at a station. The widths are linear between the given stations, and
  /// constant before the first and beyond the last given station.
  [[nodiscard]] RoadWidths At(double s) const;

 private:
  double spacing_;
  std::vector<RoadWidths> widths_;
};

/// Returns the largest distance of a footprint beyond the edges [m], negative if the footprint is
/// within the edges. Tests five points of each long side, from corner to corner. Approximates the
/// path by its circle of curvature at the rear axle. The error of this approximation is at most
/// sharpness length^3/6, with the sharpness of the path and the length of the car. The result is
/// infinite if the footprint reaches the center of the circle of curvature. Cost: 0.3 us.
double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet);

/// Computes the edges of a track relative to a path along the track, for a footprint that keeps
/// `distance` [m] from the edges. If a car on the path is closer to an edge than `distance`, the
/// footprint may come as close to this edge as that car. A car on the path is therefore always
/// within the limits, even where the path leaves the track. Beyond the path's end, the edges keep
/// the distance from the path that they have at the end.
///
/// Guarantees: the result is exact for the polylines of the edges (Track::left_edge) at stations at
/// most 0.5 m apart, and linear in between. Cost: 40 us per meter of path.
RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance);

}  // namespace trackbed

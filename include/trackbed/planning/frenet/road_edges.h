#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/track/track.h"
#include "trackbed/vehicle/params.h"

/// Limits how far the car's footprint may reach to the left and right of a path, as functions of
/// the path's station. The limits of the footprint represent the edges of a track, relative to a
/// line on the track.
///
/// Symbols: as in path/frenet_frame.h. The station s and offset d of a point of the footprint refer
/// to the nearest point of the path.
namespace trackbed {

/// The edges of the road on both sides of a path. Objects of this class are immutable.
class RoadEdges {
 public:
  /// The `widths` are the distances of the edges from the path at the stations 0, `spacing`, 2
  /// `spacing`, ... Where both edges of the road are to the left of the path, the right width is
  /// negative; where both edges are to the right, the left width is negative. Throws InternalError
  /// if `widths` is empty, or if `spacing` is not positive.
  RoadEdges(double spacing, std::vector<RoadWidths> widths);

  /// Returns the widths of the road at a station. The road widths are interpolated linearly between
  /// the given stations, and are constant before the first and beyond the last given station.
  [[nodiscard]] RoadWidths At(double s) const;

 private:
  double spacing_;
  std::vector<RoadWidths> widths_;
};

/// Returns how far the car's footprint reaches beyond the edges of the road [m]; negative if the
/// footprint is within the edges. ReachBeyond tests five points on each long side of the footprint,
/// from corner to corner. In the test of the footprint, the path is approximated by its circle of
/// curvature at the rear axle. The error of approximating the path by a circle is at most c l^3/6,
/// where c is the sharpness dkappa/ds of the path and l the length of the car. The returned reach
/// is infinite if the footprint reaches the center of the circle of curvature. Computing time: 0.3
/// us.
double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet);

/// Computes the edges of a track relative to a path along the track, for a car whose footprint
/// keeps `distance` [m] from the edges. Where a car exactly on the path would be closer to an edge
/// than `distance`, the car may come as close to this edge as it would on the path. A car exactly
/// on the path is always within the computed edges, even where the path leaves the track. Beyond
/// the path's end, the edges keep the distance that they have from the path at its end.
///
/// Guarantees: at stations at most 0.5 m apart, the computed edges are exact for the polylines of
/// the track's edges (Track::left_edge); between these stations, the computed edges are linear.
/// Computing time: 40 us per meter of path.
RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance);

}  // namespace trackbed

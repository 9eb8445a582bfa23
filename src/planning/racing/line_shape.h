#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "trackbed/planning/racing/track_line.h"

/// Lines on a track for optimizers: their shape with its derivatives, and the bounds of their
/// offset.
namespace trackbed {

/// The splines of lines' offsets, with two knots for each point of the track: in a hairpin a line
/// runs at a fraction of the center line's radius, over as much less distance, and with knots as
/// far apart as the points its curvature ripples.
ClosedSplineBasis OffsetBasis(const Track& track);

/// A value and its derivatives by d, d' and d''.
using OffsetDerivatives = Eigen::AutoDiffScalar<Eigen::Vector3d>;

/// A line at one station, from r' = (1 - kappa_c d) t + d' n of its points r over the station.
struct LineShape {
  OffsetDerivatives cross;   ///< r' x r''
  OffsetDerivatives square;  ///< |r'|^2, so that kappa = cross/square^1.5 and dl/ds = square^0.5
};
LineShape ShapeAt(const PathPoint& center, const LineOffset& offset);

/// Of d at one station [m].
struct OffsetBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// The bounds of a line that keeps `beside` [m] away from the edges, and on its own side of the
/// center of the center line's curvature.
OffsetBounds BoundsAt(const Track& track, const PathPoint& center, double s, double beside);

/// Why no line keeps them, where the bounds leave nothing.
std::string TooNarrow(const Track& track, double s, double beside);

}  // namespace trackbed

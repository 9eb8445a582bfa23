#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "trackbed/planning/racing/track_line.h"

/// Shape of a line on a track, with derivatives, and the bounds of its offset; for optimizers.
namespace trackbed {

/// Splines for the offset of lines, with two knots per point of the track. In a hairpin a line's
/// radius is a fraction of the center line's, over a correspondingly shorter distance; with one
/// knot per point its curvature would ripple.
ClosedSplineBasis OffsetBasis(const Track& track);

/// A value and its derivatives with respect to d, d' and d''.
using OffsetDerivatives = Eigen::AutoDiffScalar<Eigen::Vector3d>;

/// Shape of a line at one station, from r' = (1 - kappa_c d) t + d' n, the derivative of its points
/// r by the station.
struct LineShape {
  OffsetDerivatives cross;   ///< r' x r''
  OffsetDerivatives square;  ///< |r'|^2, so that kappa = cross/square^1.5 and dl/ds = square^0.5
};
LineShape ShapeAt(const PathPoint& center, const LineOffset& offset);

/// Bounds of d at one station [m].
struct OffsetBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// The bounds of a line that keeps `beside` [m] away from the edges and does not cross the center
/// of curvature of the center line.
OffsetBounds BoundsAt(const Track& track, const PathPoint& center, double s, double beside);

/// Why no line satisfies the bounds where they are empty, for people.
std::string TooNarrow(const Track& track, double s, double beside);

}  // namespace trackbed

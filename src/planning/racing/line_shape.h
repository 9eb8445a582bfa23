#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "trackbed/planning/racing/track_line.h"

/// Shape of a line on a track with the shape's derivatives, and the bounds of the line's offset;
/// for optimizers.
namespace trackbed {

/// Splines for the offset of lines, with two knots per point of the track. In a hairpin, a line's
/// radius is a fraction of the center line's radius, over a correspondingly shorter distance. With
/// only one knot per point, the curvature of a line in a hairpin would ripple.
ClosedSplineBasis OffsetBasis(const Track& track);

/// A value and the derivatives of this value with respect to d, d' and d''.
using OffsetDerivatives = Eigen::AutoDiffScalar<Eigen::Vector3d>;

/// Shape of a line at one station. The derivative of the line's points r by the station is r' = (1
/// - kappa_c d) t + d' n.
struct LineShape {
  OffsetDerivatives cross;  ///< Cross product r' x r''.
  /// Squared norm |r'|^2; kappa = cross/square^1.5 and dl/ds = square^0.5.
  OffsetDerivatives square;
};
LineShape ShapeAt(const PathPoint& center, const LineOffset& offset);

/// Bounds of the offset d at one station [m].
struct OffsetBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// The bounds of a line that keeps a distance of `beside` [m] from the edges. The bounds also keep
/// the line from crossing the center of curvature of the center line.
OffsetBounds BoundsAt(const Track& track, const PathPoint& center, double s, double beside);

/// Reason, for people, why no line satisfies the bounds at a station where the bounds are empty.
std::string TooNarrow(const Track& track, double s, double beside);

}  // namespace trackbed

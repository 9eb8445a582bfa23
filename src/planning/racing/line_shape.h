#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "trackbed/planning/racing/track_line.h"

/// Functions for optimizers that compute the shape of a line on a track, the derivatives of the
/// shape, and the bounds of the line's offset.
namespace trackbed {

/// Returns the spline basis for the offsets of lines, with two knots per point of the track. On the
/// inside of a hairpin, a line has a smaller radius and is shorter than the center line. With only
/// one knot per point of the track, the line's curvature would oscillate on the inside of a
/// hairpin.
ClosedSplineBasis OffsetBasis(const Track& track);

/// A value with its derivatives with respect to the offset d and the offset's derivatives d' and
/// d''.
using OffsetDerivatives = Eigen::AutoDiffScalar<Eigen::Vector3d>;

/// Shape of a line at one station. With the tangent t, the normal n and the curvature kappa_c of
/// the center line, the derivative of the line's position r with respect to the station is r' = (1
/// - kappa_c d) t + d' n.
struct LineShape {
  OffsetDerivatives cross;  ///< Cross product r' x r'' of the derivatives of the line's position.
  /// Squared norm |r'|^2, from which follow kappa = cross/square^1.5 and dl/ds = square^0.5.
  OffsetDerivatives square;
};
LineShape ShapeAt(const PathPoint& center, const LineOffset& offset);

/// Bounds of the offset d at one station [m].
struct OffsetBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// Returns the offset bounds of a line that keeps a distance of `beside` [m] from the track's
/// edges. The bounds also keep the line away from the center line's center of curvature.
OffsetBounds BoundsAt(const Track& track, const PathPoint& center, double s, double beside);

/// Returns an error message about a station at which no offset satisfies the bounds.
std::string TooNarrow(const Track& track, double s, double beside);

/// Returns the remedy for a track on which lines can keep at most the distance `room` [m] from the
/// edges. The remedy is the largest margin for a car of the given width [m], or the statement that
/// the car does not fit.
std::string RemedyForNarrowTrack(double room, double car_width);

}  // namespace trackbed

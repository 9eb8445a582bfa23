#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "src/path/points_to_fit.h"
#include "trackbed/core/angle.h"

namespace trackbed {

/// Deviation of a curve from the straight line between two adjacent knots.
struct Bulge {
  // Largest distance of the curve from the straight line between the knots [m].
  double distance = 0.0;
  // Largest distance from the straight line that is plausible for a smooth path through the points
  // [m].
  double plausible = 0.0;
  double length = 0.0;   // Length of the curve between the knots [m].
  double chord = 0.0;    // Length of the straight line between the knots [m].
  std::size_t knot = 0;  // Index of the knot at which the step between knots begins.

  /// Returns whether the curve deviates from the straight line by more than a plausible distance.
  /// IsAside permits the curve to pass the line's ends at a distance of up to the tolerance.
  [[nodiscard]] bool IsAside(double tolerance) const {
    return distance > plausible + tolerance || length > 0.5 * kPi * chord + 2.0 * tolerance;
  }
};

/// Function that returns a point of a curve between two knots. The arguments are the index of the
/// first knot, and the fraction from 0 to 1 of the way to the next knot.
using CurveBetweenKnots = std::function<Vec2(std::size_t, double)>;

/// Returns the first stretch between two knots on which a curve deviates too far from the straight
/// line (IsAside). If the curve is close enough to all straight lines, returns the stretch with the
/// largest distance.
Bulge FindBulge(const CurveBetweenKnots& curve, const ChordPoints& fitted, double period,
                double tolerance);

/// Returns the steps between knots that should be straight although the fitted curve bulges beside
/// them. At both ends of a returned step, the polyline through the knots turns by at most 45
/// degrees. The curve deviates too far from the returned step (IsAside), or the step is a gap on a
/// straight. A gap is a step more than four times as long as the median step. The polyline's
/// curvature on a gap is less than a quarter of the curvature beside the gap. On a gap, the fitted
/// curve deviates from the straight line by more than the tolerance.
std::vector<std::size_t> StraightSteps(const CurveBetweenKnots& curve, const ChordPoints& fitted,
                                       double period, double tolerance);

/// Adds points on the given straight steps between knots. At each end of a straight step, the
/// distances between the added points begin with the length of the adjacent step. Toward the middle
/// of the straight step, the distances between added points grow by a quarter from point to point.
ChordPoints WithPointsOn(const ChordPoints& fitted, double period,
                         const std::vector<std::size_t>& steps);

/// Throws InputError that names the input point that is probably wrong, and the distance at which
/// resampled points keep the spline within `tolerance` [m] of the polyline.
[[noreturn]] void RefuseBulge(const Bulge& bulge, const ChordPoints& fitted,
                              const DistinctPoints& distinct, const PathPoints& given,
                              double tolerance);

}  // namespace trackbed

#pragma once

#include <vector>

#include "src/path/points_to_fit.h"
#include "src/path/smoothing_spline.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Removes repeated points and noise from the given points. For a polyline fit, which passes all
/// points, no points are merged as noise.
DistinctPoints DistinctFor(const PathPoints& given, const PathFitOptions& options);

/// Returns those of the distinct points to which the path is fitted (knots).
ChordPoints KnotsOf(const DistinctPoints& distinct, const PathFitOptions& options);

/// Returns the points at which the direction of travel changes by more than kMaxHeadingJump.
std::vector<HeadingJump> FindReversals(const ChordPoints& chords, double period);

/// Fits a forward path to the points of one leg, with the prescribed headings at its ends, and with
/// the bound `max_curvature` [1/m] on the curvature of a spline (FitSpline). FitLeg computes
/// neither the deviation nor the heading difference. If the points turn back, FitLeg fits no path
/// and sets the reversals.
FittedPath FitLeg(PathPoints given, const PathFitOptions& options, const EndHeadings& headings,
                  double max_curvature);

}  // namespace trackbed

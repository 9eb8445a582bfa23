#pragma once

#include <vector>

#include "src/path/points_to_fit.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Fits a spline to the knots, as FitPath describes, with the options and the given points of
/// `fitted`. FitSpline sets the path, the bulge and the smoothing length of `fitted`, and the
/// station of each distinct point [m]. An open path has the prescribed headings at its ends. The
/// curve of least variation keeps the bound `max_curvature` [1/m] (LeastVariationCurve). If the
/// curve of least variation does not converge, the spline is used, which ignores the bound. Throws
/// InputError if no spline stays within the largest deviation.
void FitSpline(const ChordPoints& knots, const DistinctPoints& distinct,
               const EndHeadings& headings, double max_curvature, FittedPath& fitted,
               std::vector<double>& stations);

}  // namespace trackbed

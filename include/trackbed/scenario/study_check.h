#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/scenario/study_points.h"

/// Checks the points of a study before the study runs.
namespace trackbed {

/// Returns the indices of the points that are checked before a study is run: all points, or 1000
/// evenly spaced points that include the first and the last point.
std::vector<std::size_t> PointsToCheck(const StudyPoints& points);

/// Checks the scenarios of a study at the points from PointsToCheck. Throws InputError, which lists
/// each problem once, with one of the affected points unless all points are affected. For a
/// bisection, the scenario is checked with both end values of the bisected key and with one value
/// between them. If `all` is true, every checked point must be valid; otherwise one valid point is
/// enough.
void CheckPoints(const StudyPoints& points, bool all);

}  // namespace trackbed

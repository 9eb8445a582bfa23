#pragma once

#include <optional>
#include <vector>

#include "src/path/legs.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Returns the path with the given headings and curvatures, if they agree with the points as a
/// planner's own output does. Computes the path, the stations and the number of repeated points.
/// Returns nullopt if headings or curvatures are missing, are too inexact, or belong to another
/// path.
std::optional<FittedPath> FollowGiven(const PathPoints& given, const std::vector<Leg>& legs,
                                      const PathFitOptions& options);

}  // namespace trackbed

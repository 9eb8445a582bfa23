#pragma once

#include <optional>
#include <vector>

#include "src/path/legs.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Returns a path with the given headings and curvatures, if they agree with the points as
/// accurately as in the output of a planner. FollowGiven computes the path, its stations and the
/// number of repeated points. FollowGiven returns nullopt if headings or curvatures are missing,
/// too inexact, or belong to another path.
std::optional<FittedPath> FollowGiven(const PathPoints& given, const std::vector<Leg>& legs,
                                      const PathFitOptions& options);

}  // namespace trackbed

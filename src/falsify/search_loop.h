#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "src/falsify/point_search.h"

namespace trackbed {

/// Function that runs the scenario at several points and returns the objective value of each point.
/// A RunBatch returns nullopt to end the search.
using RunBatch = std::function<std::optional<std::vector<std::optional<double>>>(
    const std::vector<UnitPoint>& points)>;

/// Runs the points that `search` proposes and passes the resulting values back to `search`, until
/// `search` or `run` ends the search. Proposed points are rounded to the steps of `space`.
void FollowSearch(PointSearch& search, const SearchSpace& space, const RunBatch& run);

}  // namespace trackbed

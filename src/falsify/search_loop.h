#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "src/falsify/point_search.h"

namespace trackbed {

/// Returns the values at the given points; none ends the search.
using RunBatch = std::function<std::optional<std::vector<std::optional<double>>>(
    const std::vector<UnitPoint>& points)>;

/// Alternates between proposals of `search`, rounded to the steps of `space`, and their values from
/// `run`, until one of the two ends.
void FollowSearch(PointSearch& search, const SearchSpace& space, const RunBatch& run);

}  // namespace trackbed

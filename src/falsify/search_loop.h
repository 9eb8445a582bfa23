#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "src/falsify/point_search.h"

namespace trackbed {

/// The values at points, one for each; none ends the search.
using RunBatch = std::function<std::optional<std::vector<std::optional<double>>>(
    const std::vector<UnitPoint>& points)>;

/// Lets a search propose points, whose values are rounded, and tells it what `run` says of them,
/// until one of the two is at its end.
void FollowSearch(PointSearch& search, const SearchSpace& space, const RunBatch& run);

}  // namespace trackbed

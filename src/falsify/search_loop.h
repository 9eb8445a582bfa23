#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "src/falsify/point_search.h"

namespace trackbed {

/// Runs points and returns their values; returning none ends the search.
using RunBatch = std::function<std::optional<std::vector<std::optional<double>>>(
    const std::vector<UnitPoint>& points)>;

/// Alternates between proposals of `search` and their values from `run` until one of them ends the
/// search. Proposals are rounded to the steps of `space`.
void FollowSearch(PointSearch& search, const SearchSpace& space, const RunBatch& run);

}  // namespace trackbed

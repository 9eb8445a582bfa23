#pragma once

#include <memory>
#include <optional>

#include "src/falsify/point_search.h"

namespace trackbed {

/// dlib's global function search: upper bounds of what a function of a few known values can be, and
/// quadratic models around the best of them (Malherbe and Vayatis 2017; King 2017).
std::unique_ptr<PointSearch> MakeSurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                                                 std::optional<double> at_nominal);

}  // namespace trackbed

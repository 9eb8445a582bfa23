#pragma once

#include <memory>
#include <optional>

#include "src/falsify/point_search.h"

namespace trackbed {

/// Creates a global function search of dlib. The search combines the upper bound of a Lipschitz
/// function through the known values with a quadratic model around the best value (Malherbe and
/// Vayatis 2017; King 2017).
std::unique_ptr<PointSearch> MakeSurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                                                 std::optional<double> at_nominal);

}  // namespace trackbed

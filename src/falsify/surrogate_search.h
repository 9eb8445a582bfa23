#pragma once

#include <memory>
#include <optional>

#include "src/falsify/point_search.h"

namespace trackbed {

/// Creates a search that uses dlib's class global_function_search. Global exploration bounds the
/// objective by the known values and an estimated Lipschitz constant. Local refinement uses a
/// quadratic model around the best point (Malherbe and Vayatis 2017; King 2017).
std::unique_ptr<PointSearch> MakeSurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                                                 std::optional<double> at_nominal);

}  // namespace trackbed

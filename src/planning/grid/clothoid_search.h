#pragma once

#include <memory>

#include "src/planning/grid/pose_search.h"

namespace trackbed {

/// Makes a search for paths of continuous curvature.
std::unique_ptr<PoseSearch> MakeClothoidSearch(const SearchSpace& space,
                                               const Resolution& resolution, SearchSide side,
                                               std::shared_ptr<const GridDistance> left);

}  // namespace trackbed

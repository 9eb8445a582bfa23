#pragma once

#include <memory>

#include "src/planning/grid/pose_search.h"

namespace trackbed {

/// Makes a search for paths of arcs and straights, at whose joints the curvature steps.
std::unique_ptr<PoseSearch> MakeArcSearch(const SearchSpace& space, const Resolution& resolution,
                                          SearchSide side,
                                          std::shared_ptr<const GridDistance> left);

}  // namespace trackbed

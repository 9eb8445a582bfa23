#pragma once

#include <string>

#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// Returns an error message if no ground can be made from the road at this station; otherwise an
/// empty text.
std::string SurfaceError(const Road& road, double s);

}  // namespace trackbed

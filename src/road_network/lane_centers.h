#pragma once

#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"

namespace trackbed {

/// Smallest distance between two joints of polynomials along a lane center [m]; closer joints are
/// merged, because they differ only by rounding errors or enclose a negligible piece.
constexpr double kMergedJoints = 0.01;

/// Result of joining the lane centers of a route.
struct JoinedPath {
  /// Message that explains why the lane centers cannot be joined; empty on success.
  std::string failure;
  Path path;
  std::string note;        ///< Note for the user on the gaps that the path closes; empty without
                           ///< gaps.
  double deviation = 0.0;  ///< Largest distance of the path from the lane centers [m].
};

/// Computes the path along the lane centers of consecutive stretches.
JoinedPath JoinLaneCenters(const RoadNetwork& network, const std::vector<LaneStretch>& stretches);

}  // namespace trackbed

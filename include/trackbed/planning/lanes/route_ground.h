#pragma once

#include <memory>
#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"
#include "trackbed/road_network/road_network.h"
#include "trackbed/world/terrain.h"

namespace trackbed {

/// The ground under a route.
struct RouteGround {
  std::string failure;  ///< Reason why there is no ground; empty if ok.
  /// Terrain; null if the route's roads are level at one height.
  std::shared_ptr<const Terrain> terrain;
  /// Largest distance found between the terrain and the route's lanes [m].
  double deviation = 0.0;

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// Makes terrain from the elevation and superelevation of a route's roads.
///
/// On the drivable lanes of these roads, the ground is the road surface (PositionAt), interpolated
/// from points every 0.5 m (Terrain). The ground is accurate to 1 mm if elevation and
/// superelevation are smooth. Kinks and steps are rounded over half a meter. `deviation` is
/// measured every 0.15 m along the centers and borders of the driven lanes, and is at most 1 cm.
/// The road surface extends 1.5 m beyond the lanes, and blends over another 8 m into smooth ground
/// between the roads. About 100 m from the route, the ground becomes level, a meter below the
/// lowest road. Before the first place and beyond the last place of the route, the ground follows
/// the road for another 15 m. If the road ends within this distance, its surface continues straight
/// for 6 m.
///
/// Only roads of the route have heights, over the stations that the route needs. The other roads
/// lie on the smooth ground, regardless of their heights. A route may pass above or below other
/// roads, but not above or below itself.
///
/// `failure` states one of these reasons: heights in the file that are not supported; lanes of two
/// roads more than 0.1 m above each other at one place; a deviation of more than 1 cm; roads
/// steeper than 45 degrees, more than 10 km high, more than 50 m wide on either side, longer than
/// 20 km together, or extending over more than 8 km along x or y.
///
/// If FindLaneRoute finds no route, there is neither terrain nor a failure. Throws the
/// PreconditionErrors of FindLaneRoute. Cost: about 1 s and 3 MB per kilometer.
RouteGround MakeRouteGround(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"
#include "trackbed/road_network/road_network.h"
#include "trackbed/world/terrain.h"

namespace trackbed {

/// The shape of the ground under a route.
struct RouteGround {
  std::string failure;  ///< Reason why the ground could not be computed; empty if ok.
  /// Terrain under the route; null if the route's roads are all level and at the same height.
  std::shared_ptr<const Terrain> terrain;
  /// Largest measured distance between the terrain and the lanes of the route [m].
  double deviation = 0.0;

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// Makes a terrain from the elevation and superelevation of a route's roads.
///
/// On the drivable lanes of the route's roads, the ground is the road surface (PositionAt),
/// interpolated from points every 0.5 m (Terrain). The ground is accurate to 1 mm where elevation
/// and superelevation are smooth. Kinks and steps of the road surface are rounded over half a
/// meter. The deviation of the ground from the road is measured every 0.15 m along the centers and
/// borders of the driven lanes, and is at most 1 cm. The road surface is extended by 1.5 m beyond
/// the lanes, and then blends over another 8 m into smooth ground between the roads. About 100 m
/// from the route, the ground becomes level, a meter below the lowest road. Before the first place
/// and beyond the last place of the route, the ground follows the road for another 15 m. If the
/// road ends less than 15 m beyond the first or last place, the road surface is extended straight
/// for 6 m.
///
/// The terrain considers heights only for the roads of the route, and only at the stations that the
/// route needs. Roads that are not part of the route are laid on the smooth ground, regardless of
/// their heights. A route may pass above or below other roads, but not above or below itself.
///
/// RouteGround::failure states why MakeRouteGround could make no ground. MakeRouteGround fails if
/// heights in the file are of an unsupported kind, or if lanes of two roads lie more than 0.1 m
/// above each other at one place. MakeRouteGround fails if the ground deviates from the road
/// surface by more than 1 cm. MakeRouteGround fails if roads are steeper than 45 degrees, higher
/// than 10 km, wider than 50 m on either side, or longer than 20 km together. MakeRouteGround fails
/// if the roads are spread over more than 8 km along x or y.
///
/// If FindLaneRoute finds no route, the result has neither a terrain nor a failure. Throws
/// PreconditionError in the same cases as FindLaneRoute. Cost: about 1 s of computing time and 3 MB
/// of memory per kilometer of route.
RouteGround MakeRouteGround(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed

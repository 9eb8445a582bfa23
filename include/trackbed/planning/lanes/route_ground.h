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
  std::string failure;                     ///< why there is none, for people; empty if there is one
  std::shared_ptr<const Terrain> terrain;  ///< null: the route's roads are level, at one height
  double deviation = 0.0;  ///< largest distance of the terrain from the route's lanes found [m]

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// Makes the elevation and superelevation of the roads that a route leads over the ground.
///
/// On the drivable lanes of these roads the ground is their surface (PositionAt), as interpolated
/// from points every 0.5 m (Terrain): where elevation and superelevation are smooth, to 1 mm. Kinks
/// and steps are rounded over half a meter; `deviation` is measured every 0.15 m along the centers
/// and borders of the lanes that are driven, and at most 1 cm. The surface goes on beyond the lanes
/// for 1.5 m, and within another 8 m passes into smooth ground between the roads, which becomes
/// level a meter below the lowest road about 100 m from the route. Before its first and after its
/// last place the route's road goes on for 15 m, or, where it ends, straight on for 6 m.
///
/// Only roads of the route have heights, over the stations that it needs: the others of the network
/// lie on that ground, whatever theirs are. A route may pass above or below roads that are not part
/// of it, but not above or below itself.
///
/// `failure`: heights that the file has and that are not read; lanes of two roads more than 0.1 m
/// above each other at one place; a deviation of more than 1 cm; roads steeper than 45 degrees,
/// more than 10 km high or 50 m wide on either side, longer than 20 km together, or over more than
/// 8 km along x or y.
///
/// No terrain and no failure where FindLaneRoute finds no route. PreconditionError as there. Cost:
/// about 1 s and 3 MB for each kilometer.
RouteGround MakeRouteGround(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed

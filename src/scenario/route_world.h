#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Largest number of places in mission.route.
inline constexpr std::size_t kMaxLanePlaces = 1000;

/// Uses the elevation of the roads on a route as the ground of the world
/// (planning/lanes/route_ground.h). AddRouteGround may be called only after the road network was
/// read. If the roads on the route are level, the ground of the world stays unchanged. If the
/// elevation cannot be used as ground, AddRouteGround returns an error message, otherwise an empty
/// string. If the route is invalid, the ground of the world also stays unchanged.
std::string AddRouteGround(const std::vector<LanePlace>& route, World& world);

/// Reads the road network of a run's scenario file, and uses the elevation of the roads on the
/// mission's route as ground (AddRouteGround). If the mission has no route, ReadRouteGround does
/// nothing. Throws the same errors as ReadOpenDrive. Throws InputError if the mission cannot be
/// read, if the file of the road network lies outside the scenario's folder, or if the elevation
/// cannot be used as ground. The coordinates of the roads become relative to the local origin
/// `origin` of the scenario.
void ReadRouteGround(const std::filesystem::path& scenario, const Vec2& origin, World& world);

}  // namespace trackbed

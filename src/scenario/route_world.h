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
/// (planning/lanes/route_ground.h). The road network must have been read. If the roads are level,
/// the ground stays unchanged. If the elevation cannot be used as ground, AddRouteGround returns
/// the reason, otherwise an empty string. An invalid route leaves the ground unchanged.
std::string AddRouteGround(const std::vector<LanePlace>& route, World& world);

/// Reads the road network of a run's scenario file, and uses the elevation of the roads on the
/// mission's route as ground (AddRouteGround). ReadRouteGround does nothing if the mission has no
/// route. Throws the same errors as ReadOpenDrive. Throws InputError if the mission cannot be read,
/// the network lies in another folder, or the elevation cannot be used as ground.
void ReadRouteGround(const std::filesystem::path& scenario, World& world);

}  // namespace trackbed

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

/// Uses the elevation of a route's roads as the world's ground (planning/lanes/route_ground.h). The
/// road network must have been read. If the roads are level, the ground stays unchanged.
/// AddRouteGround returns the reason if the roads cannot be the ground, else an empty string. An
/// invalid route leaves the ground unchanged.
std::string AddRouteGround(const std::vector<LanePlace>& route, World& world);

/// Same as AddRouteGround, for the world of a run's scenario file. ReadRouteGround reads the road
/// network if the mission has a route. Throws the errors of ReadOpenDrive. Throws InputError if the
/// mission cannot be read, the network lies in another folder, or the roads cannot be ground.
void ReadRouteGround(const std::filesystem::path& scenario, World& world);

}  // namespace trackbed

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// The most places of mission.route.
inline constexpr std::size_t kMostLanePlaces = 1000;

/// Makes the heights of a route's roads the world's ground (planning/lanes/route_ground.h), if its
/// road network is read and not level there. Says why that cannot be, or nothing; a route that is
/// none is no ground.
std::string AddRouteGround(const std::vector<LanePlace>& route, World& world);

/// The same for the world of a run's scenario file, whose road network is read if the mission has a
/// route. Errors: those of ReadOpenDrive; InputError for a mission that cannot be read, a network
/// elsewhere, and roads that cannot be ground.
void ReadRouteGround(const std::filesystem::path& scenario, World& world);

}  // namespace trackbed

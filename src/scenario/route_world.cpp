#include "src/scenario/route_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "src/scenario/local_origin.h"
#include "src/scenario/read_section.h"
#include "src/scenario/visit.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/lanes/route_ground.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

std::string AddRouteGround(const std::vector<LanePlace>& route, World& world) {
  if (!world.road_network || !world.road_network->data || route.size() < 2 ||
      route.size() > kMaxLanePlaces) {
    return "";
  }
  const RoadNetwork& network = world.road_network->data->network;
  if (!std::all_of(route.begin(), route.end(), [&](const LanePlace& place) {
        return LanePlaceError(network, place).empty();
      })) {
    return "";
  }
  RouteGround ground = MakeRouteGround(network, route);
  world.ground.terrain = std::move(ground.terrain);
  return ground.failure;
}

void ReadRouteGround(const std::filesystem::path& scenario, const Vec2& origin, World& world) {
  if (!world.road_network) {
    return;
  }
  const auto mission = ReadSection<MissionSpec>(scenario, kMissionSection);
  if (mission.route.empty()) {
    return;
  }
  const std::filesystem::path folder = scenario.parent_path();
  const auto fail = [&](const char* key, std::string message) {
    throw InputError(Problem{.file = scenario.string(), .key = key, .message = std::move(message)});
  };
  const std::string& file = world.road_network->file;
  if (const std::string why = ReadAccessError(file, folder, {}); !why.empty()) {
    fail("world.road_network", fmt::format("{} {}", file, why));
  }
  world.road_network->data =
      std::make_shared<const OpenDriveFile>(RoadsFrom(ReadOpenDriveFile(folder / file), origin));
  if (std::string why = AddRouteGround(mission.route, world); !why.empty()) {
    fail("mission.route", std::move(why));
  }
}

}  // namespace trackbed

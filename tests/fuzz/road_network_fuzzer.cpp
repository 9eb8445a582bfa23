#include <algorithm>
#include <utility>

#include "tests/fuzz/target.h"
#include "trackbed/planning/lanes/route_ground.h"
#include "trackbed/road_network/open_drive.h"

/// Fuzzes an OpenDRIVE road network: positions on its lanes, a route between lanes, and the ground.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  fuzz::Expect([&] {
    const RoadNetwork network = ParseOpenDrive(fuzz::Text(data, size), "roads.xodr");
    std::vector<LanePlace> places;
    for (const auto& [id, road] : network.roads) {
      for (const Lane& lane : road.sections.front().lanes) {
        static_cast<void>(LanePositionAt(road, lane.id, 0.0));
        const LanePlace place{id, lane.id, std::min(0.5 * road.length, road.SectionEnd(0))};
        if (LanePlaceError(network, place).empty() && places.size() < 3) {
          places.push_back(place);
        }
      }
      static_cast<void>(PositionAt(road, road.length, 1.0));
    }
    // Only for short networks: an input must take less than 10 s.
    const bool is_short =
        std::all_of(network.roads.begin(), network.roads.end(),
                    [](const auto& entry) { return entry.second.length < 1000.0; });
    if (places.size() >= 2 && is_short) {
      static_cast<void>(MakeRouteGround(network, places));
      // Visits places along the network's first lane.
      LanePlace from = places.front();
      const Road& road = network.roads.find(from.road)->second;
      LanePlace to = from;
      from.s = 0.25 * road.SectionEnd(0);
      to.s = 0.75 * road.SectionEnd(0);
      if (!FollowsRoad(road, from.lane)) {
        std::swap(from, to);
      }
      if (LanePlaceError(network, from).empty() && LanePlaceError(network, to).empty()) {
        static_cast<void>(MakeRouteGround(network, {from, to}));
      }
    }
  });
  return 0;
}

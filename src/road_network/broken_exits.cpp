#include "src/road_network/broken_exits.h"

#include <fmt/format.h>

#include <optional>

namespace trackbed {
namespace {

/// Collects the broken links at the end of a lane.
class Exits {
 public:
  Exits(const RoadNetwork& network, const LaneNode& node) : network_(network), node_(node) {}

  std::vector<std::string> Find() {
    const Road& road = *node_.road;
    const Lane& lane = *road.sections[node_.section].Find(node_.lane);
    const bool forward = node_.follows_road();
    const std::vector<int>& ids = forward ? lane.successors : lane.predecessors;
    if (forward ? node_.section + 1 < road.sections.size() : node_.section > 0) {
      CheckLanes(road, forward ? node_.section + 1 : node_.section - 1, ids);
      return found_;
    }
    AddBroken(fmt::format("road {} {}", road.id, forward ? "successor" : "predecessor"));
    const std::optional<RoadLink>& link = forward ? road.successor : road.predecessor;
    if (!link) {
      return found_;
    }
    if (link->is_junction) {
      CheckJunction(link->id);
    } else if (const Road* next = FindRoad(link->id)) {
      CheckLanes(*next, link->contact == RoadEnd::kStart ? 0 : next->sections.size() - 1, ids);
    }
    return found_;
  }

 private:
  /// Lists a part of the network in `found_` if the reader left the part out. Returns whether the
  /// part was left out.
  bool AddBroken(const std::string& part) {
    const auto broken = network_.broken.find(part);
    if (broken != network_.broken.end()) {
      found_.push_back(fmt::format("{} is left out, because of {}", part, broken->second));
    }
    return broken != network_.broken.end();
  }

  void AddMissing(const std::string& part) {
    if (!AddBroken(part)) {
      found_.push_back(fmt::format("{}, to which lane {} of road {} leads, is not in the file",
                                   part, node_.lane, node_.road->id));
    }
  }

  const Road* FindRoad(const std::string& id) {
    const auto found = network_.roads.find(id);
    if (found == network_.roads.end()) {
      AddMissing("road " + id);
      return nullptr;
    }
    return &found->second;
  }

  void CheckLanes(const Road& road, std::size_t section, const std::vector<int>& ids) {
    for (const int id : ids) {
      if (road.sections[section].Find(id) == nullptr) {
        AddMissing(fmt::format("lane {} of road {} at s = {:.4g} m", id, road.id,
                               road.sections[section].s));
      }
    }
  }

  void CheckJunction(const std::string& id) {
    AddBroken(fmt::format("junction {} connection", id));
    const auto junction = network_.junctions.find(id);
    if (junction == network_.junctions.end()) {
      AddMissing("junction " + id);
      return;
    }
    for (const JunctionConnection& connection : junction->second.connections) {
      if (connection.incoming != node_.road->id) {
        continue;
      }
      for (const auto& [from, to] : connection.lane_links) {
        if (from != node_.lane) {
          continue;
        }
        if (const Road* road = FindRoad(connection.connecting)) {
          CheckLanes(*road, connection.contact == RoadEnd::kStart ? 0 : road->sections.size() - 1,
                     {to});
        }
      }
    }
  }

  const RoadNetwork& network_;
  const LaneNode& node_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> BrokenExits(const RoadNetwork& network, const LaneNode& node) {
  return Exits(network, node).Find();
}

}  // namespace trackbed

#pragma once

#include <boost/graph/adjacency_list.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/road_network/road_network.h"

/// The drivable lanes of a network, and the links between these lanes.
namespace trackbed {

/// A node of the lane graph: a lane within one lane section.
struct LaneNode {
  const Road* road = nullptr;
  std::size_t section = 0;
  int lane = 0;

  [[nodiscard]] double start() const { return road->sections[section].s; }
  [[nodiscard]] double end() const { return road->SectionEnd(section); }
  [[nodiscard]] bool follows_road() const { return FollowsRoad(*road, lane); }
  bool operator==(const LaneNode&) const = default;
};

/// Graph of the drivable lanes of a network. The graph keeps a reference to the network.
class LaneGraph {
 public:
  explicit LaneGraph(const RoadNetwork& network);

  /// Returns the index of a lane's node; nullopt if the lane is not drivable.
  [[nodiscard]] std::optional<std::size_t> Find(const Road& road, std::size_t section,
                                                int lane) const;
  [[nodiscard]] const LaneNode& node(std::size_t index) const { return nodes_[index]; }

  /// Returns the shortest path in driving direction from the end of one lane to the start of
  /// another lane. The returned path of lanes contains the lanes `from` and `to`. If `from` and
  /// `to` are the same lane, the path is a loop. Returns an empty path if the target lane cannot be
  /// reached. The computing time is O(n log n) for n lanes.
  [[nodiscard]] std::vector<std::size_t> ShortestWay(std::size_t from, std::size_t to) const;

  /// Returns texts for error messages on at most three broken parts of the file at which the paths
  /// that begin at the lane `from` end. Broken parts are links to roads, junctions or lanes that
  /// are missing or left out.
  [[nodiscard]] std::vector<std::string> BrokenPartsFrom(std::size_t from) const;

 private:
  /// Each link of the lane graph has as weight the length of the lane where the link begins [m].
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property,
                            boost::property<boost::edge_weight_t, double>>;

  void Link(std::size_t from, std::size_t to);
  void AddLinks(std::size_t index);
  void AddJunction(std::size_t index, const std::string& id);
  /// Adds a link from the node `from` to a lane of `road`, which the car enters at the end
  /// `contact` of the road.
  void AddLink(std::size_t from, const Road& road, RoadEnd contact, int lane);

  const RoadNetwork& network_;
  // All lanes of the graph, grouped by road and ordered by section and lane.
  std::vector<LaneNode> nodes_;
  // For each road, the index of its first node in the list of all nodes.
  std::map<std::string, std::size_t, std::less<>> first_;
  // For each road, the index after its last node in the list of all nodes.
  std::map<std::string, std::size_t, std::less<>> last_;
  Graph links_;
};

}  // namespace trackbed

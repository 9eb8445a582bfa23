#pragma once

#include <boost/graph/adjacency_list.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/road_network/road_network.h"

/// The lanes of a network that vehicles drive on, and how they are linked.
namespace trackbed {

/// A lane within one lane section.
struct LaneNode {
  const Road* road = nullptr;
  std::size_t section = 0;
  int lane = 0;

  [[nodiscard]] double start() const { return road->sections[section].s; }
  [[nodiscard]] double end() const { return road->SectionEnd(section); }
  [[nodiscard]] bool follows_road() const { return FollowsRoad(*road, lane); }
  bool operator==(const LaneNode&) const = default;
};

/// The drivable lanes of a network, which must outlive it.
class LaneGraph {
 public:
  explicit LaneGraph(const RoadNetwork& network);

  /// None unless the lane is drivable.
  [[nodiscard]] std::optional<std::size_t> Find(const Road& road, std::size_t section,
                                                int lane) const;
  [[nodiscard]] const LaneNode& node(std::size_t index) const { return nodes_[index]; }

  /// The shortest way from the end of one lane to the start of another, both included, in the
  /// direction of traffic; the two may be the same, for a way around. Empty when there is none.
  /// Cost O(lanes log lanes).
  [[nodiscard]] std::vector<std::size_t> ShortestWay(std::size_t from, std::size_t to) const;

 private:
  /// The weight of a link is the length of the lane that it leaves [m].
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property,
                            boost::property<boost::edge_weight_t, double>>;

  void Link(std::size_t from, std::size_t to);
  void AddLinks(std::size_t index);
  void AddJunction(std::size_t index, const std::string& id);
  /// A link to a lane of a road that is entered at `contact`.
  void AddLink(std::size_t from, const Road& road, RoadEnd contact, int lane);

  const RoadNetwork& network_;
  std::vector<LaneNode> nodes_;  // of each road together, in the order of sections and lanes
  std::map<std::string, std::size_t, std::less<>> first_;  // of each road
  std::map<std::string, std::size_t, std::less<>> last_;   // one beyond
  Graph links_;
};

}  // namespace trackbed

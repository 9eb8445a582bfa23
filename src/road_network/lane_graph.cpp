#include "src/road_network/lane_graph.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <limits>
#include <tuple>

namespace trackbed {

LaneGraph::LaneGraph(const RoadNetwork& network) : network_(network) {
  for (const auto& [id, road] : network.roads) {
    first_[id] = nodes_.size();
    for (std::size_t section = 0; section < road.sections.size(); ++section) {
      for (const Lane& lane : road.sections[section].lanes) {
        if (lane.id != 0 && IsDrivable(lane)) {
          nodes_.push_back({&road, section, lane.id});
        }
      }
    }
    last_[id] = nodes_.size();
  }
  links_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    AddLinks(i);
  }
}

std::optional<std::size_t> LaneGraph::Find(const Road& road, std::size_t section, int lane) const {
  const auto begin = nodes_.begin() + static_cast<std::ptrdiff_t>(first_.at(road.id));
  const auto end = nodes_.begin() + static_cast<std::ptrdiff_t>(last_.at(road.id));
  const auto key = [](const LaneNode& node) { return std::tuple(node.section, -node.lane); };
  const LaneNode wanted{&road, section, lane};
  const auto found = std::lower_bound(
      begin, end, wanted, [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return found != end && *found == wanted
             ? std::optional(static_cast<std::size_t>(found - nodes_.begin()))
             : std::nullopt;
}

void LaneGraph::AddLink(std::size_t from, const Road& road, RoadEnd contact, int lane) {
  const bool at_start = contact == RoadEnd::kStart;
  const auto to = Find(road, at_start ? 0 : road.sections.size() - 1, lane);
  if (to && nodes_[*to].follows_road() == at_start) {
    links_[from].push_back(*to);
  }
}

void LaneGraph::AddJunction(std::size_t index, const std::string& id) {
  const LaneNode& node = nodes_[index];
  const auto junction = network_.junctions.find(id);
  if (junction == network_.junctions.end()) {
    return;
  }
  for (const JunctionConnection& connection : junction->second.connections) {
    const auto road = network_.roads.find(connection.connecting);
    if (connection.incoming != node.road->id || road == network_.roads.end()) {
      continue;
    }
    // Of a road with both ends at one junction the lane's number tells which end is left.
    for (const auto& [from, to] : connection.lane_links) {
      if (from == node.lane) {
        AddLink(index, road->second, connection.contact, to);
      }
    }
  }
}

void LaneGraph::AddLinks(std::size_t index) {
  const LaneNode& node = nodes_[index];
  const Road& road = *node.road;
  const Lane& lane = *road.sections[node.section].Find(node.lane);
  const bool forward = node.follows_road();
  const std::vector<int>& ids = forward ? lane.successors : lane.predecessors;
  if (forward ? node.section + 1 < road.sections.size() : node.section > 0) {
    for (const int id : ids) {
      const auto next = Find(road, forward ? node.section + 1 : node.section - 1, id);
      if (next && nodes_[*next].follows_road() == forward) {
        links_[index].push_back(*next);
      }
    }
    return;
  }
  const std::optional<RoadLink>& link = forward ? road.successor : road.predecessor;
  if (!link) {
    return;
  }
  if (link->is_junction) {
    AddJunction(index, link->id);
    return;
  }
  const auto next = network_.roads.find(link->id);
  if (next != network_.roads.end()) {
    for (const int id : ids) {
      AddLink(index, next->second, link->contact, id);
    }
  }
}

std::vector<std::size_t> LaneGraph::ShortestWay(std::size_t from, std::size_t to) const {
  // The start as one vertex more, which nothing leads to, so that a way may come back to it.
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property,
                            boost::property<boost::edge_weight_t, double>>;
  const std::size_t start = nodes_.size();
  Graph graph(nodes_.size() + 1);
  const auto add = [&](std::size_t vertex, std::size_t links_of) {
    for (const std::size_t next : links_[links_of]) {
      boost::add_edge(vertex, next, nodes_[next].end() - nodes_[next].start(), graph);
    }
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    add(i, i);
  }
  add(start, from);
  std::vector<std::size_t> before(nodes_.size() + 1);
  std::vector<double> distance(nodes_.size() + 1);
  boost::dijkstra_shortest_paths(
      graph, start, boost::predecessor_map(before.data()).distance_map(distance.data()));
  if (distance[to] == std::numeric_limits<double>::max()) {
    return {};
  }
  std::vector<std::size_t> way;
  for (std::size_t at = to; at != start; at = before[at]) {
    way.push_back(at);
  }
  way.push_back(from);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace trackbed

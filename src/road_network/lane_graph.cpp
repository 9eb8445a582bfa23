#include "src/road_network/lane_graph.h"

#include <algorithm>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <functional>
#include <limits>
#include <tuple>

#include "src/road_network/broken_exits.h"

namespace trackbed {

LaneGraph::LaneGraph(const RoadNetwork& network) : network_(network) {
  for (const auto& [id, road] : network.roads) {
    first_[id] = nodes_.size();
    for (std::size_t section = 0; section < road.sections.size(); ++section) {
      for (const Lane& lane : road.sections[section].lanes) {
        if (lane.id != 0 && IsDrivable(lane)) {
          nodes_.push_back({&road, section, lane.id});
          boost::add_vertex(links_);
        }
      }
    }
    last_[id] = nodes_.size();
  }
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
    Link(from, *to);
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
    // If both ends of a road are connected to the same junction, the sign of the lane's number
    // determines at which end of the road the car leaves it.
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
        Link(index, *next);
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

void LaneGraph::Link(std::size_t from, std::size_t to) {
  boost::add_edge(from, to, nodes_[from].end() - nodes_[from].start(), links_);
}

std::vector<std::string> LaneGraph::BrokenPartsFrom(std::size_t from) const {
  constexpr std::size_t kMaxParts = 3;
  std::vector<std::string> parts;
  std::vector<bool> seen(nodes_.size(), false);
  std::vector<std::size_t> open{from};
  seen[from] = true;
  for (std::size_t i = 0; i < open.size() && parts.size() < kMaxParts; ++i) {
    for (const std::string& part : BrokenExits(network_, nodes_[open[i]])) {
      if (std::find(parts.begin(), parts.end(), part) == parts.end() && parts.size() < kMaxParts) {
        parts.push_back(part);
      }
    }
    const auto [begin, end] = boost::adjacent_vertices(open[i], links_);
    for (auto next = begin; next != end; ++next) {
      if (!seen[*next]) {
        seen[*next] = true;
        open.push_back(*next);
      }
    }
  }
  return parts;
}

std::vector<std::size_t> LaneGraph::ShortestWay(std::size_t from, std::size_t to) const {
  // Start the search at the successors of the first lane, so that a loop back to the first lane can
  // be found.
  const auto [begin, end] = boost::adjacent_vertices(from, links_);
  std::vector<std::size_t> before(nodes_.size());
  std::vector<double> distance(nodes_.size());
  constexpr double kUnreachable = std::numeric_limits<double>::max();
  boost::dijkstra_shortest_paths(links_, begin, end, before.data(), distance.data(),
                                 boost::get(boost::edge_weight, links_),
                                 boost::get(boost::vertex_index, links_), std::less<>(),
                                 std::plus<>(), kUnreachable, 0.0, boost::dijkstra_visitor<>());
  if (distance[to] == kUnreachable) {
    return {};
  }
  std::vector<std::size_t> way{to};
  while (before[way.back()] != way.back()) {
    way.push_back(before[way.back()]);
  }
  way.push_back(from);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace trackbed

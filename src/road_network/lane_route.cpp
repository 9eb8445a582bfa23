#include "trackbed/road_network/lane_route.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/road_network/lane_centers.h"
#include "src/road_network/lane_graph.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

constexpr double kMinStretchLength = 1e-6;  // Length below which a route's stretch is dropped [m].
constexpr double kMaxRouteLength = 1e5;     // Largest length of a route [m].

std::string Named(const LanePlace& place) {
  return fmt::format("lane {} of road {} at s = {:.4g} m", place.lane, place.road, place.s);
}

/// The road, the lane section and the node of the lane graph in which a place of a route lies.
struct Found {
  const Road* road;
  std::size_t section;
  std::size_t node;
};

/// Collects the stretches of a route and computes the total length of the stretches.
class Stretches {
 public:
  void Add(const Road& road, int lane, int to_lane, double from, double to) {
    if (std::abs(to - from) > kMinStretchLength) {
      length_ += std::abs(to - from);
      all_.push_back({road.id, lane, to_lane, from, to});
    }
  }
  /// AddUpToEnd adds the part of a lane from station `from` to the lane's end. AddFromStart adds
  /// the part of a lane from the lane's start to station `to`.
  void AddUpToEnd(const LaneNode& node, double from) {
    Add(*node.road, node.lane, node.lane, from, node.follows_road() ? node.end() : node.start());
  }
  void AddFromStart(const LaneNode& node, double to) {
    Add(*node.road, node.lane, node.lane, node.follows_road() ? node.start() : node.end(), to);
  }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] std::vector<LaneStretch> Take() { return std::move(all_); }

 private:
  std::vector<LaneStretch> all_;
  double length_ = 0.0;
};

Found FindPlace(const RoadNetwork& network, const LaneGraph& graph, const LanePlace& place) {
  const std::string why = LanePlaceError(network, place);
  TRACKBED_REQUIRE(why.empty(), "FindLaneRoute: {}", why);
  const Road& road = network.roads.find(place.road)->second;
  const std::size_t section = road.SectionAt(place.s);
  return {&road, section, graph.Find(road, section, place.lane).value()};
}

/// Adds the stretches of lanes between two places of a route. If no path connects the two places,
/// returns an error message, otherwise an empty text.
std::string Connect(const LaneGraph& graph, const LanePlace& a, const Found& from,
                    const LanePlace& b, const Found& to, Stretches& stretches) {
  const LaneNode& node = graph.node(from.node);
  const bool ahead = node.follows_road() ? b.s > a.s : b.s < a.s;
  if (from.node == to.node && ahead) {
    stretches.Add(*from.road, a.lane, a.lane, a.s, b.s);
    return "";
  }
  const bool beside = from.road == to.road && from.section == to.section &&
                      std::abs(a.lane - b.lane) == 1 && (a.lane > 0) == (b.lane > 0);
  if (beside && ahead) {
    stretches.Add(*from.road, a.lane, b.lane, a.s, b.s);
    return "";
  }
  const std::vector<std::size_t> way = graph.ShortestWay(from.node, to.node);
  if (way.empty()) {
    const std::vector<std::string> broken = graph.BrokenPartsFrom(from.node);
    return fmt::format("no linked lanes lead from {} to {}{}{}", Named(a), Named(b),
                       broken.empty() ? "" : "; on the way, ", fmt::join(broken, "; "));
  }
  stretches.AddUpToEnd(node, a.s);
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const LaneNode& between = graph.node(way[i]);
    stretches.AddUpToEnd(between, between.follows_road() ? between.start() : between.end());
  }
  stretches.AddFromStart(graph.node(to.node), b.s);
  return "";
}

}  // namespace

Pose2 PoseAt(const RoadNetwork& network, const LanePlace& place) {
  const std::string why = LanePlaceError(network, place);
  TRACKBED_REQUIRE(why.empty(), "PoseAt: {}", why);
  const Road& road = network.roads.find(place.road)->second;
  const bool follows = FollowsRoad(road, place.lane);
  const std::size_t section = road.SectionAt(place.s);
  // The first pose of a route is computed from the road polynomials beyond joints that are merged
  // (kMergedJoints). If the route begins less than 1 cm before a kink, its first pose therefore has
  // the heading after the kink.
  const double beyond = std::clamp(place.s + (follows ? 2.0 : -2.0) * kMergedJoints,
                                   road.sections[section].s, road.SectionEnd(section));
  const double piece_of = 0.5 * (place.s + beyond);
  const CubicValue offset = LaneBordersAt(road, section, place.lane, place.s, piece_of).Center();
  const SurfaceLine center = SurfaceLineAt(road, offset, place.s, piece_of);
  return {center.position.x(), center.position.y(),
          WrapAngle(follows ? center.heading : center.heading + kPi)};
}

std::string LanePlaceError(const RoadNetwork& network, const LanePlace& place) {
  const auto found = network.roads.find(place.road);
  if (found == network.roads.end()) {
    const auto broken = network.broken.find("road " + place.road);
    if (broken != network.broken.end()) {
      return fmt::format("road {} is left out, because of {}", place.road, broken->second);
    }
    std::vector<std::string> ids;
    for (const auto& [id, road] : network.roads) {
      ids.push_back(id);
    }
    return "unknown road " + UnknownName(place.road, ids);
  }
  const Road& road = found->second;
  if (!(place.s >= 0.0 && place.s <= road.length)) {
    return fmt::format("s = {} m is not on road {}; must be between 0 and {} m", place.s, road.id,
                       road.length);
  }
  const LaneSection& section = road.sections[road.SectionAt(place.s)];
  const Lane* lane = section.Find(place.lane);
  if (lane == nullptr || lane->id == 0 || !IsDrivable(*lane)) {
    std::vector<int> ids;
    for (const Lane& other : section.lanes) {
      if (other.id != 0 && IsDrivable(other)) {
        ids.push_back(other.id);
      }
    }
    return fmt::format(
        "road {} has no lane {} to drive on at s = {} m{}; it has {}", road.id, place.lane, place.s,
        lane == nullptr || lane->id == 0 ? "" : fmt::format(", but a {} lane", lane->type),
        ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", ")));
  }
  return "";
}

LaneRoute FindLaneRoute(const RoadNetwork& network, const std::vector<LanePlace>& places) {
  TRACKBED_REQUIRE(places.size() >= 2, "FindLaneRoute: {} places; must be at least 2",
                   places.size());
  const LaneGraph graph(network);
  std::vector<Found> found;
  for (const LanePlace& place : places) {
    found.push_back(FindPlace(network, graph, place));
  }
  LaneRoute route;
  Stretches stretches;
  for (std::size_t i = 1; i < places.size(); ++i) {
    route.failure = Connect(graph, places[i - 1], found[i - 1], places[i], found[i], stretches);
    if (route.ok() && stretches.length() > kMaxRouteLength) {
      route.failure = fmt::format("the route is longer than {} km", kMaxRouteLength / 1000.0);
    }
    if (!route.ok()) {
      return route;
    }
  }
  route.stretches = stretches.Take();
  if (route.stretches.empty()) {
    route.failure = "the route has no length";
    return route;
  }
  JoinedPath joined = JoinLaneCenters(network, route.stretches);
  route.failure = std::move(joined.failure);
  route.path = std::move(joined.path);
  route.deviation = joined.deviation;
  route.note = std::move(joined.note);
  return route;
}

}  // namespace trackbed

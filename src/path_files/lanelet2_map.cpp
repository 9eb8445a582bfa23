#include "src/path_files/lanelet2_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path_files/formats.h"
#include "src/path_files/lanelet_orientation.h"
#include "trackbed/core/text_table.h"
#include "trackbed/path_files/globe.h"

// A lanelet is a relation of a left and a right way, each a list of nodes. As in the Lanelet2
// library, the ways are oriented so that the left way lies to the left of the right one. A lanelet
// follows another one if both of its bounds begin at the nodes at which the other bounds end. A car
// may change to a lanelet beside if both share a way with a dashed line. A lanelet that is not
// one_way is two lanelets of opposite directions.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr const char* kReversed = " reversed";  // Key suffix for a lanelet's other direction.

std::string Attribute(const XMLElement& element, const char* name) {
  const char* text = element.Attribute(name);
  return text == nullptr ? "" : text;
}

OsmTags TagsOf(const XMLElement& element) {
  OsmTags tags;
  for (const XMLElement* tag = element.FirstChildElement("tag"); tag != nullptr;
       tag = tag->NextSiblingElement("tag")) {
    tags[Attribute(*tag, "k")] = Attribute(*tag, "v");
  }
  return tags;
}

std::string ValueOf(const OsmTags& tags, const std::string& key) {
  const auto found = tags.find(key);
  return found == tags.end() ? "" : found->second;
}

/// Returns whether a lanelet with these tags is open to cars.
bool IsForCars(const OsmTags& tags) {
  if (const std::string vehicles = ValueOf(tags, "participant:vehicle"); !vehicles.empty()) {
    return vehicles == "yes";
  }
  const std::string subtype = ValueOf(tags, "subtype");
  return subtype.empty() || subtype == "road" || subtype == "highway" || subtype == "play_street" ||
         subtype == "exit" || subtype == "road_shoulder";
}

/// Returns whether a car may cross a line that lies on its right (`from_left`) or on its left.
bool MayCross(const OsmTags& line, bool from_left, bool is_reversed) {
  if (const std::string change = ValueOf(line, "lane_change"); !change.empty()) {
    return change == "yes";
  }
  const std::string subtype = ValueOf(line, "subtype");
  return subtype == "dashed" ||
         subtype == (from_left != is_reversed ? "dashed_solid" : "solid_dashed");
}

}  // namespace

LaneletBound LaneletBound::Reversed() const {
  return {way, !is_reversed, last, first, {points.rbegin(), points.rend()}};
}

std::optional<double> SpeedOfTag(const std::string& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789.+-eE"), text.size());
  const std::optional<double> number = CellNumber(text.substr(0, end));
  const std::size_t begin = text.find_first_not_of(" \t", end);
  const std::string unit = begin == std::string::npos ? "km/h" : text.substr(begin);
  const double factor = unit == "km/h" || unit == "kmh" || unit == "kph" ? 1.0 / 3.6
                        : unit == "mph"                                  ? 0.44704
                        : unit == "m/s" || unit == "mps"                 ? 1.0
                                                                         : 0.0;
  if (!number || !(*number * factor > 0.0) || *number * factor > kMaxPathSpeed) {
    return std::nullopt;
  }
  return *number * factor;
}

Lanelet2Map::Lanelet2Map(const fs::path& file, const XMLElement& root, const PathMap& map)
    : file_(file) {
  for (const XMLElement* node = root.FirstChildElement("node"); node != nullptr;
       node = node->NextSiblingElement("node")) {
    nodes_[Attribute(*node, "id")] = {.element = node, .tags = TagsOf(*node)};
  }
  for (const XMLElement* way = root.FirstChildElement("way"); way != nullptr;
       way = way->NextSiblingElement("way")) {
    OsmWay& own = ways_[Attribute(*way, "id")];
    own.tags = TagsOf(*way);
    for (const XMLElement* nd = way->FirstChildElement("nd"); nd != nullptr;
         nd = nd->NextSiblingElement("nd")) {
      own.nodes.push_back(Attribute(*nd, "ref"));
    }
  }
  std::vector<const XMLElement*> relations;
  for (const XMLElement* relation = root.FirstChildElement("relation"); relation != nullptr;
       relation = relation->NextSiblingElement("relation")) {
    if (ValueOf(TagsOf(*relation), "type") == "lanelet") {
      relations.push_back(relation);
    }
  }
  PlaceNodes(relations, map);
  LaneletOrientation orientation;
  for (const XMLElement* relation : relations) {
    std::string why;
    if (const std::optional<LaneletBounds> bounds = BoundsOf(*relation, why)) {
      orientation.Add(*bounds);
    }
  }
  for (const XMLElement* relation : relations) {
    Add(*relation, orientation);
  }
  Link();
}

std::vector<std::string> Lanelet2Map::DirectionsOf(const std::string& id) const {
  std::vector<std::string> keys;
  for (const std::string& key : {id, id + kReversed}) {
    if (lanelets_.contains(key)) {
      keys.push_back(key);
    }
  }
  if (keys.empty()) {
    const auto why = left_out_.find(id);
    Refuse(file_, "lanelets",
           why == left_out_.end() ? fmt::format("no lanelet {} in the file; {}", id, Some())
                                  : fmt::format("lanelet {} {}", id, why->second));
  }
  return keys;
}

std::string Lanelet2Map::Some() const {
  std::vector<std::string> ids;
  for (const auto& [key, lanelet] : lanelets_) {
    if (ids.size() < 10 && !key.ends_with(kReversed)) {
      ids.push_back(key);
    }
  }
  return fmt::format("{} lanelets are for cars, such as {}", lanelets_.size(),
                     fmt::join(ids, ", "));
}

/// Returns the nodes of a lanelet's way; nullptr, with a reason in `why`, if the
/// lanelet has no such way.
const OsmWay* Lanelet2Map::WayOf(const XMLElement& relation, const std::string& role,
                                 std::string& id, std::string& why) const {
  int count = 0;
  for (const XMLElement* member = relation.FirstChildElement("member"); member != nullptr;
       member = member->NextSiblingElement("member")) {
    if (Attribute(*member, "role") == role && Attribute(*member, "type") == "way") {
      id = Attribute(*member, "ref");
      ++count;
    }
  }
  const auto found = ways_.find(id);
  if (count != 1) {
    why = fmt::format("has {} ways of the role {}; must have 1", count, role);
  } else if (found == ways_.end()) {
    why = fmt::format("has the {} way {}, which is not in the file", role, id);
  } else if (found->second.nodes.size() < 2) {
    why = fmt::format("has the {} way {} with fewer than 2 nodes", role, id);
  } else {
    for (const std::string& node : found->second.nodes) {
      if (!nodes_.contains(node)) {
        why = fmt::format("has the way {}, whose node {} is not in the file", id, node);
      }
    }
  }
  return why.empty() ? &found->second : nullptr;
}

/// Returns a coordinate of a node.
double Lanelet2Map::Coordinate(const OsmNode& node, const char* name, const std::string& text,
                               double largest) const {
  const std::optional<double> number = CellNumber(text);
  if (!number || std::abs(*number) > largest) {
    Refuse(file_, name,
           fmt::format("'{}' is not a number between {} and {}", text.substr(0, 40), -largest,
                       largest),
           node.element->GetLineNum());
  }
  return *number;
}

/// Computes the places of the nodes of lanelets: local_x and local_y if all nodes have these tags,
/// otherwise the projection of latitude and longitude.
void Lanelet2Map::PlaceNodes(const std::vector<const XMLElement*>& relations, const PathMap& map) {
  std::vector<OsmNode*> used;
  for (const XMLElement* relation : relations) {
    for (const char* role : {"left", "right"}) {
      std::string id;
      std::string why;
      if (const OsmWay* way = WayOf(*relation, role, id, why)) {
        for (const std::string& node : way->nodes) {
          used.push_back(&nodes_.at(node));
        }
      }
    }
  }
  const bool is_local = std::all_of(used.begin(), used.end(), [](const OsmNode* node) {
    return node->tags.contains("local_x") && node->tags.contains("local_y");
  });
  if (used.empty()) {
    return;
  }
  if (is_local) {
    for (OsmNode* node : used) {
      node->place = {Coordinate(*node, "local_x", node->tags.at("local_x"), kMaxPosition),
                     Coordinate(*node, "local_y", node->tags.at("local_y"), kMaxPosition)};
    }
    notes_.emplace_back("positions are local_x and local_y");
    return;
  }
  std::vector<GlobePosition> positions;
  for (const OsmNode* node : used) {
    positions.push_back(
        {Coordinate(*node, "lat", Attribute(*node->element, "lat"), kMaxLatitude),
         Coordinate(*node, "lon", Attribute(*node->element, "lon"), kMaxLongitude)});
  }
  const GlobePoints projected = ProjectGlobe(positions, OriginOf(map));
  if (!projected.problem.empty()) {
    Refuse(file_, "node", projected.problem, used[projected.bad]->element->GetLineNum());
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i]->place = projected.points[i];
  }
  notes_.push_back(projected.note);
}

LaneletBound Lanelet2Map::BoundOf(const std::string& id, const OsmWay& way) const {
  LaneletBound bound{id, false, way.nodes.front(), way.nodes.back(), {}};
  for (const std::string& node : way.nodes) {
    bound.points.push_back(nodes_.at(node).place);
  }
  return bound;
}

/// Returns the bounds of a lanelet as the file gives their nodes; nothing, with a reason in `why`,
/// if a bound is missing.
std::optional<LaneletBounds> Lanelet2Map::BoundsOf(const XMLElement& relation,
                                                   std::string& why) const {
  std::string left_id;
  std::string right_id;
  const OsmWay* left = WayOf(relation, "left", left_id, why);
  const OsmWay* right = why.empty() ? WayOf(relation, "right", right_id, why) : nullptr;
  if (left == nullptr || right == nullptr) {
    return std::nullopt;
  }
  return LaneletBounds{BoundOf(left_id, *left), BoundOf(right_id, *right)};
}

void Lanelet2Map::Add(const XMLElement& relation, const LaneletOrientation& orientation) {
  const std::string id = Attribute(relation, "id");
  const OsmTags tags = TagsOf(relation);
  if (!IsForCars(tags)) {
    left_out_[id] = fmt::format("is a {}, which is not for cars", ValueOf(tags, "subtype"));
    return;
  }
  std::string why;
  const std::optional<LaneletBounds> bounds = BoundsOf(relation, why);
  if (!bounds) {
    left_out_[id] = fmt::format("(line {}) {}", relation.GetLineNum(), why);
    return;
  }
  LaneletBounds oriented = orientation.Orient(*bounds);
  DirectedLanelet own{
      .left = std::move(oriented.left), .right = std::move(oriented.right), .limit = kMaxPathSpeed};
  if (const std::string limit = ValueOf(tags, "speed_limit"); !limit.empty()) {
    const std::optional<double> speed = SpeedOfTag(limit);
    own.has_limit = speed.has_value();
    own.limit = speed.value_or(kMaxPathSpeed);
    if (!speed) {
      notes_.push_back(fmt::format("line {}: the speed limit '{}' is not read",
                                   relation.GetLineNum(), limit.substr(0, 40)));
    }
  }
  Insert(id, own, relation.GetLineNum());
  if (ValueOf(tags, "one_way") == "no") {
    std::swap(own.left, own.right);
    own.left = own.left.Reversed();
    own.right = own.right.Reversed();
    Insert(id + kReversed, own, relation.GetLineNum());
  }
}

void Lanelet2Map::Insert(const std::string& key, const DirectedLanelet& own, int line) {
  std::optional<Lanelet> lanelet = LaneletBetween(own.left.points, own.right.points);
  if (!lanelet) {
    left_out_[key] = "has no length";
    return;
  }
  lanelet->line = line;
  if (!lanelets_.emplace(key, std::move(*lanelet)).second) {
    Refuse(file_, "relation", fmt::format("two lanelets have the id {}", key), line);
  }
  directed_.emplace(key, own);
}

/// Links each lanelet with its successors, and with the lanelets beside it.
void Lanelet2Map::Link() {
  std::multimap<std::pair<std::string, std::string>, std::string> starts;
  std::multimap<std::pair<std::string, bool>, std::string> right_of;
  for (const auto& [key, own] : directed_) {
    starts.emplace(std::pair(own.left.first, own.right.first), key);
    right_of.emplace(std::pair(own.left.way, own.left.is_reversed), key);
  }
  for (const auto& [key, own] : directed_) {
    const auto [begin, end] = starts.equal_range({own.left.last, own.right.last});
    for (auto next = begin; next != end; ++next) {
      lanelets_.at(key).successors.push_back(next->second);
    }
    const OsmTags& line = ways_.at(own.right.way).tags;
    const auto [first, last] = right_of.equal_range({own.right.way, own.right.is_reversed});
    for (auto beside = first; beside != last; ++beside) {
      if (MayCross(line, true, own.right.is_reversed)) {
        lanelets_.at(key).neighbors.push_back(beside->second);
      }
      if (MayCross(line, false, own.right.is_reversed)) {
        lanelets_.at(beside->second).neighbors.push_back(key);
      }
    }
  }
}

}  // namespace trackbed

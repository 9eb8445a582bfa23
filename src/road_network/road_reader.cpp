#include "src/road_network/road_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>
#include <utility>

#include "src/road_network/lane_reader.h"
#include "src/road_network/plan_view.h"
#include "trackbed/core/spelling.h"

// Reads one road of an OpenDRIVE file: links, heights, lane offset and lane sections.
// 1. The class XmlFields reads each XML element and collects problems with their line numbers.
// 2. ReadHeights reads elevation, superelevation and shape, and adds notes on height definitions
//    that are not supported.
// 3. After all roads are read, CheckLinks compares the links of lanes and roads with the elements
//    to which they refer. An invalid link is left out, with a note.
// Source: ASAM OpenDRIVE 1.7.0.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

/// Reads a link of a road. A road link with an error is left out.
std::optional<RoadLink> ReadRoadLink(const XmlFields& road, const char* name, const std::string& id,
                                     RoadNetwork& network) {
  const XMLElement* link = road.element().FirstChildElement("link");
  const XMLElement* element = link == nullptr ? nullptr : link->FirstChildElement(name);
  if (element == nullptr) {
    return std::nullopt;
  }
  XmlProblems own(road.problems().file());
  const XmlFields fields(*element, fmt::format("{}.link.{}", road.where(), name), own);
  RoadLink found{.is_junction = false,
                 .id = fields.Text("elementId"),
                 .contact = RoadEnd::kStart,
                 .line = fields.line()};
  const std::string type = fields.Text("elementType");
  if (type == "junction") {
    found.is_junction = true;
  } else if (type == "road") {
    found.contact = ReadContactPoint(fields);
  } else if (!type.empty()) {
    fields.AddError("elementType", UnknownName(type, {"road", "junction"}));
  }
  if (!own.empty()) {
    road.problems().AddFlaws(own);
    network.broken.emplace(fmt::format("road {} {}", id, name), own.First());
    return std::nullopt;
  }
  return found;
}

bool IsZero(const PiecewiseCubic& function) {
  return std::all_of(function.pieces().begin(), function.pieces().end(), [](const auto& piece) {
    return piece.coefficients == std::array<double, 4>{};
  });
}

/// Reads the height profiles across a road. Returns an empty list if all heights of the profiles
/// are 0.
std::vector<ShapeProfile> ReadShape(const XMLElement* lateral, const std::string& where,
                                    XmlProblems& problems) {
  struct Record {
    double s = 0.0;
    PiecewiseCubic::Piece piece;
  };
  std::vector<Record> records;
  ForEachChild(lateral, "shape", [&](const XMLElement& element, std::size_t index) {
    const XmlFields fields(element, fmt::format("{}.shape[{}]", where, index), problems);
    records.push_back(
        {fields.Number("s", {0.0, 1e6}),
         {fields.Number("t", {-1e4, 1e4}),
          {fields.Number("a"), fields.Number("b"), fields.Number("c"), fields.Number("d")}}});
  });
  const bool is_flat = std::all_of(records.begin(), records.end(), [](const Record& record) {
    return record.piece.coefficients == std::array<double, 4>{};
  });
  if (is_flat) {
    return {};
  }
  std::stable_sort(records.begin(), records.end(), [](const Record& a, const Record& b) {
    return std::tie(a.s, a.piece.s) < std::tie(b.s, b.piece.s);
  });
  std::vector<ShapeProfile> profiles;
  for (std::size_t i = 0; i < records.size();) {
    std::vector<PiecewiseCubic::Piece> pieces;
    const double s = records[i].s;
    for (; i < records.size() && records[i].s == s; ++i) {
      pieces.push_back(records[i].piece);
    }
    profiles.push_back({s, PiecewiseCubic(std::move(pieces))});
  }
  return profiles;
}

void ReadHeights(const XmlFields& fields, Road& road) {
  const std::string& where = fields.where();
  const XMLElement* elevation = fields.Child("elevationProfile");
  road.elevation =
      ReadCubics(elevation, "elevation", "s", where + ".elevationProfile", fields.problems());
  const XMLElement* lateral = fields.Child("lateralProfile");
  road.superelevation =
      ReadCubics(lateral, "superelevation", "s", where + ".lateralProfile", fields.problems());
  road.shape = ReadShape(lateral, where + ".lateralProfile", fields.problems());
  bool has_crossfall = false;
  ForEachChild(lateral, "crossfall", [&](const XMLElement& element, std::size_t) {
    XmlProblems own(fields.problems().file());
    const XmlFields record(element, where, own);
    for (const char* coefficient : {"a", "b", "c", "d"}) {
      has_crossfall = has_crossfall || record.Number(coefficient) != 0.0 || !own.empty();
    }
  });
  if (has_crossfall) {
    road.unread_heights.emplace_back("crossfall");
  }
  if (lateral != nullptr && lateral->FirstChildElement("crossSectionSurface") != nullptr) {
    road.unread_heights.emplace_back("crossSectionSurface");
  }
}

/// Checks that the adjacent lane section contains all lanes whose numbers are in `ids`.
void CheckLaneIds(const std::vector<int>& ids, const LaneSection& beyond, const std::string& key,
                  int line, XmlProblems& problems) {
  for (const int id : ids) {
    if (beyond.Find(id) == nullptr) {
      problems.AddFlaw(line, key, fmt::format("links to lane {}, which is not there", id));
    }
  }
}

/// Checks the lane links between the lane sections of a road, and the lane links to adjacent roads.
void CheckLaneLinks(const RoadNetwork& network, const Road& road, XmlProblems& problems) {
  const auto beyond = [&](const std::optional<RoadLink>& link) -> const LaneSection* {
    if (!link || link->is_junction) {
      return nullptr;
    }
    const auto found = network.roads.find(link->id);
    if (found == network.roads.end() || found->second.sections.empty()) {
      return nullptr;
    }
    const auto& sections = found->second.sections;
    return link->contact == RoadEnd::kStart ? &sections.front() : &sections.back();
  };
  for (std::size_t i = 0; i < road.sections.size(); ++i) {
    const LaneSection* before = i > 0 ? &road.sections[i - 1] : beyond(road.predecessor);
    const LaneSection* after =
        i + 1 < road.sections.size() ? &road.sections[i + 1] : beyond(road.successor);
    for (const Lane& lane : road.sections[i].lanes) {
      const std::string key =
          fmt::format("road[{}].lanes.laneSection[{}].lane[{}].link", road.id, i, lane.id);
      if (before != nullptr) {
        CheckLaneIds(lane.predecessors, *before, key + ".predecessor", road.line, problems);
      }
      if (after != nullptr) {
        CheckLaneIds(lane.successors, *after, key + ".successor", road.line, problems);
      }
    }
  }
}

void CheckConnection(const RoadNetwork& network, const Junction& junction, std::size_t index,
                     XmlProblems& problems) {
  const JunctionConnection& connection = junction.connections[index];
  const std::string key = fmt::format("junction[{}].connection[{}]", junction.id, index);
  for (const auto& [name, id] : {std::pair("incomingRoad", &connection.incoming),
                                 std::pair("connectingRoad", &connection.connecting)}) {
    if (!id->empty() && network.roads.find(*id) == network.roads.end()) {
      problems.AddFlaw(connection.line, fmt::format("{}.{}", key, name),
                       fmt::format("road '{}' is not there", *id));
    }
  }
  const auto found = network.roads.find(connection.connecting);
  if (found == network.roads.end() || found->second.sections.empty()) {
    return;
  }
  const auto& sections = found->second.sections;
  const LaneSection& entered =
      connection.contact == RoadEnd::kStart ? sections.front() : sections.back();
  for (const auto& [from, to] : connection.lane_links) {
    CheckLaneIds({to}, entered, key + ".laneLink.to", connection.line, problems);
  }
}

}  // namespace

RoadEnd ReadContactPoint(const XmlFields& fields) {
  const std::string contact = fields.Text("contactPoint");
  if (!contact.empty() && contact != "start" && contact != "end") {
    fields.AddError("contactPoint", UnknownName(contact, {"start", "end"}));
  }
  return contact == "end" ? RoadEnd::kEnd : RoadEnd::kStart;
}

PiecewiseCubic ReadCubics(const XMLElement* parent, const char* name, const char* start,
                          const std::string& where, XmlProblems& problems) {
  std::vector<PiecewiseCubic::Piece> pieces;
  ForEachChild(parent, name, [&](const XMLElement& element, std::size_t index) {
    const XmlFields fields(element, fmt::format("{}.{}[{}]", where, name, index), problems);
    const PiecewiseCubic::Piece piece{
        fields.Number(start, {0.0, 1e6}),
        {fields.Number("a"), fields.Number("b"), fields.Number("c"), fields.Number("d")}};
    if (!pieces.empty() && piece.s < pieces.back().s) {
      problems.AddFlaw(
          fields.line(), fmt::format("{}.{}", fields.where(), start),
          fmt::format("{} m is before the record above, at {} m; the records are read in the "
                      "order of their stations",
                      piece.s, pieces.back().s));
    }
    pieces.push_back(piece);
  });
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.s < b.s; });
  return PiecewiseCubic(std::move(pieces));
}

Road ReadRoad(const XMLElement& element, const Vec2& origin, XmlProblems& problems,
              RoadNetwork& network) {
  const XmlFields unnamed(element, "road", problems);
  Road road;
  road.id = unnamed.Text("id");
  const XmlFields fields(element, fmt::format("road[{}]", road.id), problems);
  road.line = fields.line();
  road.name = fields.OptionalText("name");
  const std::string junction = fields.OptionalText("junction");
  if (!junction.empty() && junction != "-1") {
    road.junction = junction;
  }
  const std::string rule = fields.OptionalText("rule");
  road.left_hand_traffic = rule == "LHT" || rule == "lht";
  if (!rule.empty() && !road.left_hand_traffic && rule != "RHT" && rule != "rht") {
    fields.AddError("rule", UnknownName(rule, {"RHT", "LHT"}));
  }
  road.predecessor = ReadRoadLink(fields, "predecessor", road.id, network);
  road.successor = ReadRoadLink(fields, "successor", road.id, network);
  road.reference = ReadPlanView(fields, origin);
  road.length = ReadLength(fields, road.reference);
  ReadHeights(fields, road);
  const XMLElement* lanes = fields.Child("lanes");
  if (lanes == nullptr) {
    fields.AddError("lanes", "missing");
    return road;
  }
  const XmlFields lane_fields(*lanes, fields.where() + ".lanes", problems);
  road.lane_offset = ReadCubics(lanes, "laneOffset", "s", lane_fields.where(), problems);
  road.sections = ReadLaneSections(lane_fields, road, road.unread_heights);
  // On a road without lateral slope, the attribute `level` of a lane has no effect.
  if (IsZero(road.superelevation) && road.shape.empty()) {
    std::erase(road.unread_heights, "level lane");
  }
  return road;
}

void CheckLinks(const RoadNetwork& network, XmlProblems& problems) {
  for (const auto& [id, road] : network.roads) {
    for (const auto& [name, link] :
         {std::pair("predecessor", &road.predecessor), std::pair("successor", &road.successor)}) {
      if (!*link || (*link)->id.empty()) {
        continue;
      }
      const bool found = (*link)->is_junction
                             ? network.junctions.find((*link)->id) != network.junctions.end()
                             : network.roads.find((*link)->id) != network.roads.end();
      if (!found) {
        problems.AddFlaw((*link)->line, fmt::format("road[{}].link.{}", id, name),
                         fmt::format("{} '{}' is not there",
                                     (*link)->is_junction ? "junction" : "road", (*link)->id));
      }
    }
    CheckLaneLinks(network, road, problems);
  }
  for (const auto& [id, junction] : network.junctions) {
    for (std::size_t i = 0; i < junction.connections.size(); ++i) {
      CheckConnection(network, junction, i, problems);
    }
  }
}

}  // namespace trackbed

#include "src/road_network/lane_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace trackbed {
namespace {

using tinyxml2::XMLElement;

void ReadLaneLinks(const XmlFields& fields, Lane& lane) {
  const XMLElement* link = fields.Child("link");
  const auto read = [&](const char* name, std::vector<int>& ids) {
    ForEachChild(link, name, [&](const XMLElement& element, std::size_t) {
      ids.push_back(
          XmlFields(element, fields.where() + ".link." + name, fields.problems()).Integer("id"));
    });
  };
  read("predecessor", lane.predecessors);
  read("successor", lane.successors);
}

void ReadRoadMarks(const XmlFields& fields, Lane& lane) {
  ForEachChild(&fields.element(), "roadMark", [&](const XMLElement& element, std::size_t index) {
    // An invalid road mark is reported only as a note, because no car needs road marks.
    XmlProblems own(fields.problems().file());
    const XmlFields mark(element, fmt::format("{}.roadMark[{}]", fields.where(), index), own);
    double s = mark.Number("sOffset", {-1e6, 1e6});
    if (s < 0.0) {
      own.AddFlaw(mark.line(), mark.where() + ".sOffset",
                  fmt::format("{} m; the mark is drawn from the start of the lane section", s));
      s = 0.0;
    }
    RoadMark read{.s = s,
                  .type = mark.Text("type"),
                  .color = mark.OptionalText("color"),
                  .width = mark.Number("width", {0.0, 10.0}, 0.0)};
    if (own.empty()) {
      lane.marks.push_back(std::move(read));
    }
    fields.problems().AddFlaws(own);
  });
  std::stable_sort(lane.marks.begin(), lane.marks.end(),
                   [](const RoadMark& a, const RoadMark& b) { return a.s < b.s; });
}

void ReadExtent(const XmlFields& fields, bool has_lane_offset, Lane& lane) {
  const XMLElement& element = fields.element();
  lane.has_border = element.FirstChildElement("width") == nullptr &&
                    element.FirstChildElement("border") != nullptr;
  const char* name = lane.has_border ? "border" : "width";
  if (element.FirstChildElement(name) == nullptr) {
    fields.AddError("", "neither <width> nor <border>");
    return;
  }
  if (lane.has_border && has_lane_offset) {
    fields.AddError("border", "not allowed with a <laneOffset>; give <width>");
    return;
  }
  lane.extent = ReadCubics(&element, name, "sOffset", fields.where(), fields.problems());
  constexpr double kStartSlack = 1e-3;  // [m]
  const auto& pieces = lane.extent.pieces();
  if (!pieces.empty() && pieces.front().s > kStartSlack) {
    fields.AddError(
        name, fmt::format("begins at sOffset {} m; the first must begin at 0", pieces.front().s));
  } else if (!pieces.empty() && pieces.front().s > 0.0) {
    auto moved = pieces;
    moved.front().s = 0.0;
    lane.extent = PiecewiseCubic(std::move(moved));
  }
}

Lane ReadLane(const XmlFields& fields, int id, bool has_lane_offset,
              std::vector<std::string>& unread_heights) {
  Lane lane{.id = id, .type = fields.OptionalText("type")};
  if (lane.type.empty()) {
    lane.type = "none";
  }
  if (id != 0) {
    ReadExtent(fields, has_lane_offset, lane);
  }
  ReadLaneLinks(fields, lane);
  ReadRoadMarks(fields, lane);
  const auto unread = [&](const char* what) {
    if (std::find(unread_heights.begin(), unread_heights.end(), what) == unread_heights.end()) {
      unread_heights.emplace_back(what);
    }
  };
  bool has_height = false;
  ForEachChild(&fields.element(), "height", [&](const XMLElement& element, std::size_t index) {
    const XmlFields height(element, fmt::format("{}.height[{}]", fields.where(), index),
                           fields.problems());
    // Ignore the heights of sidewalks, because a raised sidewalk does not affect the surface on
    // which cars drive.
    has_height = has_height || height.Number("inner", {}, 0.0) != 0.0 ||
                 height.Number("outer", {}, 0.0) != 0.0;
  });
  if (has_height && IsDrivable(lane)) {
    unread("lane height");
  }
  const std::string level = fields.OptionalText("level");
  if ((level == "true" || level == "1") && IsDrivable(lane)) {
    unread("level lane");
  }
  return lane;
}

/// Reads the lanes of a <left>, <center> or <right> element.
void ReadSide(const XmlFields& section, const char* side, bool has_lane_offset, LaneSection& into,
              std::vector<std::string>& unread_heights) {
  const XMLElement* group = section.Child(side);
  const std::string_view name(side);
  ForEachChild(group, "lane", [&](const XMLElement& element, std::size_t) {
    const XmlFields unnamed(element, fmt::format("{}.{}.lane", section.where(), side),
                            section.problems());
    const int id = unnamed.Integer("id");
    const XmlFields fields(element, fmt::format("{}.{}.lane[{}]", section.where(), side, id),
                           section.problems());
    // Maximum number of lanes on each side of a road, as in mission.route.
    constexpr int kMaxLanes = 100;
    if (id < -kMaxLanes || id > kMaxLanes) {
      fields.AddError("id", fmt::format("{} is out of range; must be at least {} and at most {}",
                                        id, -kMaxLanes, kMaxLanes));
      return;
    }
    if ((name == "left") != (id > 0) || (name == "right") != (id < 0)) {
      fields.AddError("id", fmt::format("{} must be {} in <{}>", id,
                                        name == "left"    ? "above 0"
                                        : name == "right" ? "below 0"
                                                          : "0",
                                        side));
      return;
    }
    into.lanes.push_back(ReadLane(fields, id, has_lane_offset, unread_heights));
  });
}

void CheckNumbers(const XmlFields& fields, LaneSection& section) {
  std::stable_sort(section.lanes.begin(), section.lanes.end(),
                   [](const Lane& a, const Lane& b) { return a.id > b.id; });
  const auto center = std::find_if(section.lanes.begin(), section.lanes.end(),
                                   [](const Lane& lane) { return lane.id == 0; });
  if (center == section.lanes.end()) {
    fields.AddError("center", "missing; a lane section needs a lane 0");
    return;
  }
  for (std::size_t i = 1; i < section.lanes.size(); ++i) {
    if (section.lanes[i].id != section.lanes[i - 1].id - 1) {
      fields.AddError("", fmt::format("lane {} is followed by lane {}; lanes must be numbered "
                                      "without gaps and once",
                                      section.lanes[i - 1].id, section.lanes[i].id));
      return;
    }
  }
}

}  // namespace

std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights) {
  std::vector<LaneSection> sections;
  const auto& offsets = road.lane_offset.pieces();
  const bool has_offset =
      std::any_of(offsets.begin(), offsets.end(), [](const PiecewiseCubic::Piece& piece) {
        return piece.coefficients != std::array<double, 4>{};
      });
  ForEachChild(&lanes.element(), "laneSection", [&](const XMLElement& element, std::size_t index) {
    const XmlFields fields(element, fmt::format("{}.laneSection[{}]", lanes.where(), index),
                           lanes.problems());
    LaneSection section{.s = fields.Number("s", {0.0, 1e6}), .lanes = {}};
    const std::string single = fields.OptionalText("singleSide");
    if (single == "true" || single == "1") {
      fields.AddError("singleSide", "lane sections of one side are not read");
    }
    for (const char* side : {"left", "center", "right"}) {
      ReadSide(fields, side, has_offset, section, unread_heights);
    }
    CheckNumbers(fields, section);
    constexpr double kFirst = 1e-3;  // [m]
    if (sections.empty() && section.s > kFirst) {
      fields.AddError("s", fmt::format("{} m; the first lane section must begin at 0", section.s));
    } else if (!sections.empty() && section.s <= sections.back().s) {
      fields.AddError("s", fmt::format("{} m is not beyond the section before, at {} m", section.s,
                                       sections.back().s));
    } else if (section.s >= road.length) {
      fields.problems().AddFlaw(
          fields.line(), fields.where() + ".s",
          fmt::format("{} m is not on the road of {} m; the lane section is left out", section.s,
                      road.length));
      return;
    }
    section.s = sections.empty() ? 0.0 : section.s;
    sections.push_back(std::move(section));
  });
  if (sections.empty()) {
    lanes.AddError("laneSection", "missing");
  }
  return sections;
}

}  // namespace trackbed

#include "src/path_files/lanelets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string_view>
#include <tuple>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"

// Lanelets of CommonRoad and Lanelet2 maps: geometry, and the shortest route.
// 1. LaneletBetween resamples the bounds if their numbers of points differ; the center consists of
//    the midpoints.
// 2. LaneletsAt finds the lanelets that contain a pose and lead in its direction; if there are
//    none, the nearest one within 5 m.
// 3. FindLaneletRoute is Dijkstra's algorithm over successors and neighbors. A lane change has a
//    fixed cost; of equally long routes, the one that changes lanes earlier costs less.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

/// Returns the point at a fraction in [0, 1] of a polyline's length.
Vec2 PointAtFraction(const std::vector<Vec2>& line, double fraction) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    length += (line[i] - line[i - 1]).norm();
  }
  double rest = fraction * length;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i] - line[i - 1]).norm();
    if (rest <= step && step > 0.0) {
      return line[i - 1] + rest / step * (line[i] - line[i - 1]);
    }
    rest -= step;
  }
  return line.back();
}

std::vector<Vec2> Resampled(const std::vector<Vec2>& line, std::size_t count) {
  std::vector<Vec2> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(
        PointAtFraction(line, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return points;
}

std::vector<Vec2> ReadBound(const XMLElement& lanelet, const char* name,
                            const CommonRoadReading& reading) {
  const XMLElement& bound = RequiredChild(lanelet, name, reading);
  std::vector<Vec2> points;
  for (const XMLElement* point = bound.FirstChildElement("point"); point != nullptr;
       point = point->NextSiblingElement("point")) {
    points.push_back(PointIn(*point, reading));
  }
  if (points.size() < 2) {
    Refuse(reading.file, name,
           fmt::format("{} point{}; a bound has at least 2", points.size(),
                       points.size() == 1 ? "" : "s"),
           bound.GetLineNum());
  }
  return points;
}

std::string IdOf(const XMLElement& element, const char* attribute,
                 const CommonRoadReading& reading) {
  const char* id = element.Attribute(attribute);
  if (id == nullptr) {
    Refuse(reading.file, element.Name(), fmt::format("the attribute '{}' is missing", attribute),
           element.GetLineNum());
  }
  return id;
}

/// A candidate lanelet: the number by which candidates are compared, and the key of the lanelet.
using Candidate = std::pair<double, std::string>;

/// Cost of a change to an adjacent lanelet, as a distance [m]: a route changes lanes only where it
/// must.
constexpr double kLaneChangeCost = 5.0;

}  // namespace

double Lanelet::Length() const {
  double length = 0.0;
  for (std::size_t i = 1; i < center.size(); ++i) {
    length += (center[i] - center[i - 1]).norm();
  }
  return length;
}

bool Lanelet::Contains(const Vec2& point) const {
  if ((point.array() < low.array()).any() || (point.array() > high.array()).any()) {
    return false;
  }
  std::vector<Vec2> ring = left;
  ring.insert(ring.end(), right.rbegin(), right.rend());
  // Counts the polygon edges to the right of the point that cross the line y = point.y().
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2& a = ring[i];
    const Vec2& b = ring[j];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

std::optional<Lanelet> LaneletBetween(std::vector<Vec2> left, std::vector<Vec2> right) {
  Lanelet lanelet;
  lanelet.left = std::move(left);
  lanelet.right = std::move(right);
  if (lanelet.left.size() != lanelet.right.size()) {
    const std::size_t count = std::max(lanelet.left.size(), lanelet.right.size());
    lanelet.left = Resampled(lanelet.left, count);
    lanelet.right = Resampled(lanelet.right, count);
  }
  lanelet.low = lanelet.left.front();
  lanelet.high = lanelet.low;
  for (std::size_t i = 0; i < lanelet.left.size(); ++i) {
    lanelet.center.emplace_back(0.5 * (lanelet.left[i] + lanelet.right[i]));
    lanelet.low = lanelet.low.cwiseMin(lanelet.left[i]).cwiseMin(lanelet.right[i]);
    lanelet.high = lanelet.high.cwiseMax(lanelet.left[i]).cwiseMax(lanelet.right[i]);
  }
  constexpr double kShortest = 0.01;  // [m]
  const Vec2& start = lanelet.center.front();
  if (std::all_of(lanelet.center.begin(), lanelet.center.end(),
                  [&](const Vec2& point) { return (point - start).norm() < kShortest; })) {
    return std::nullopt;
  }
  return lanelet;
}

DrawnLanes DrawnLanesOf(const Lanelets& lanelets, const std::vector<Vec2>& path) {
  constexpr double kReach = 150.0;  // [m]
  DrawnLanes lanes;
  for (const auto& [id, lanelet] : lanelets) {
    lanes.push_back({lanelet.left, lanelet.right});
  }
  return LanesNear(lanes, path, kReach);
}

Lanelets ReadLanelets(const XMLElement& root, const CommonRoadReading& reading) {
  Lanelets lanelets;
  for (const XMLElement* element = root.FirstChildElement("lanelet"); element != nullptr;
       element = element->NextSiblingElement("lanelet")) {
    std::vector<Vec2> left = ReadBound(*element, "leftBound", reading);
    std::vector<Vec2> right = ReadBound(*element, "rightBound", reading);
    std::optional<Lanelet> between = LaneletBetween(std::move(left), std::move(right));
    if (!between) {
      continue;
    }
    Lanelet& lanelet = *between;
    lanelet.line = element->GetLineNum();
    for (const XMLElement* child = element->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string_view name = child->Name();
      const char* direction = child->Attribute("drivingDir");
      if (name == "successor") {
        lanelet.successors.push_back(IdOf(*child, "ref", reading));
      } else if ((name == "adjacentLeft" || name == "adjacentRight") && direction != nullptr &&
                 std::string_view(direction) == "same") {
        lanelet.neighbors.push_back(IdOf(*child, "ref", reading));
      }
    }
    if (!lanelets.emplace(IdOf(*element, "id", reading), std::move(lanelet)).second) {
      Refuse(reading.file, "lanelet",
             fmt::format("two lanelets have the id {}", IdOf(*element, "id", reading)),
             element->GetLineNum());
    }
  }
  const auto missing = [&](const std::string& id) { return !lanelets.contains(id); };
  for (auto& [id, lanelet] : lanelets) {
    std::erase_if(lanelet.successors, missing);
    std::erase_if(lanelet.neighbors, missing);
  }
  return lanelets;
}

std::vector<CommonRoadRegion> RegionsOf(const Lanelet& lanelet, std::size_t count) {
  std::vector<CommonRoadRegion> regions;
  const std::vector<Vec2> left = Resampled(lanelet.left, count + 1);
  const std::vector<Vec2> right = Resampled(lanelet.right, count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    regions.push_back({.corners = {right[i], right[i + 1], left[i + 1], left[i]}});
  }
  return regions;
}

PolylinePlace PlaceOn(const std::vector<Vec2>& line, const Vec2& point) {
  PolylinePlace best{.distance = std::numeric_limits<double>::infinity()};
  double station = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec2 edge = line[i] - line[i - 1];
    const double length = edge.norm();
    if (length == 0.0) {
      continue;
    }
    const Vec2 along = edge / length;
    const double at = std::clamp(along.dot(point - line[i - 1]), 0.0, length);
    const Vec2 apart = point - (line[i - 1] + at * along);
    if (apart.norm() < best.distance) {
      best = {station + at, apart.norm(), std::copysign(apart.norm(), Cross(along, apart)),
              std::atan2(along.y(), along.x())};
    }
    station += length;
  }
  return best;
}

std::vector<std::string> LaneletsAt(const Lanelets& lanelets, const Pose2& pose) {
  constexpr double kMaxDistance = 5.0;  // Largest distance from a pose to the nearest lanelet [m].
  // Lanelets whose direction differs by more than kMaxTurn from the pose's heading are for oncoming
  // or crossing traffic.
  constexpr double kMaxTurn = 0.5 * kPi;  // [rad]
  std::vector<Candidate> inside;
  std::vector<Candidate> near;
  for (const auto& [id, lanelet] : lanelets) {
    const PolylinePlace place = PlaceOn(lanelet.center, pose.position());
    const double turn = std::abs(AngleDifference(place.yaw, pose.yaw));
    if (turn > kMaxTurn) {
      continue;
    }
    if (lanelet.Contains(pose.position())) {
      inside.emplace_back(turn, id);
    } else if (place.distance <= kMaxDistance) {
      near.emplace_back(place.distance, id);
    }
  }
  std::vector<Candidate>& found = inside.empty() ? near : inside;
  std::sort(found.begin(), found.end());
  std::vector<std::string> ids;
  for (const Candidate& each : found) {
    ids.push_back(each.second);
  }
  if (inside.empty() && ids.size() > 1) {
    ids.resize(1);
  }
  return ids;
}

std::optional<std::vector<LaneletLane>> FindLaneletRoute(const Lanelets& lanelets,
                                                         const std::vector<std::string>& starts,
                                                         const std::vector<std::string>& goals) {
  struct Reached {
    double cost = std::numeric_limits<double>::infinity();
    std::string from;
    bool by_lane_change = false;
  };
  std::map<std::string, Reached> reached;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  for (const std::string& start : starts) {
    reached[start] = {0.0, "", false};
    queue.emplace(0.0, start);
  }
  while (!queue.empty()) {
    const auto [cost, id] = queue.top();
    queue.pop();
    if (cost > reached[id].cost) {
      continue;
    }
    if (std::find(goals.begin(), goals.end(), id) != goals.end()) {
      std::vector<LaneletLane> lanes{{}};
      std::string at = id;
      for (;;) {
        const Reached& step = reached[at];
        lanes.back().push_back(&lanelets.at(at));
        if (step.from.empty()) {
          break;
        }
        if (step.by_lane_change) {
          lanes.emplace_back();
        }
        at = step.from;
      }
      for (LaneletLane& lane : lanes) {
        std::reverse(lane.begin(), lane.end());
      }
      std::reverse(lanes.begin(), lanes.end());
      return lanes;
    }
    const Lanelet& lanelet = lanelets.at(id);
    const auto go = [&, from = id](const std::string& to, double next, bool by_lane_change) {
      if (next < reached[to].cost) {
        reached[to] = {next, from, by_lane_change};
        queue.emplace(next, to);
      }
    };
    const double length = lanelet.Length();
    for (const std::string& next : lanelet.successors) {
      go(next, cost + length, false);
    }
    // Of equally long routes, the one that changes lanes earlier costs less.
    for (const std::string& next : lanelet.neighbors) {
      go(next, cost + kLaneChangeCost + 1e-3 * cost, true);
    }
  }
  return std::nullopt;
}

}  // namespace trackbed

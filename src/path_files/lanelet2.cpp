#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/path_files/formats.h"
#include "src/path_files/lanelet2_map.h"
#include "src/path_files/lanelet_path.h"
#include "trackbed/core/foreign_content.h"

// Reads a route along the lanelets of a Lanelet2 map as a path.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr double kMaxRouteLength = 5e4;  // [m]

/// A route: its parts between lane changes, and the keys of its lanelets.
struct Lanelet2Route {
  std::vector<LaneletLane> lanes{{}};
  std::map<const Lanelet*, std::string> keys;
};

Lanelet2Route RouteOf(const fs::path& file, const Lanelet2Map& map,
                      const std::vector<std::string>& ids) {
  Lanelet2Route route;
  std::map<const Lanelet*, std::string> names;
  for (const auto& [key, lanelet] : map.lanelets()) {
    names[&lanelet] = key;
  }
  std::vector<std::string> at = map.DirectionsOf(ids.front());
  if (ids.size() == 1) {
    at.resize(1);
  }
  for (std::size_t i = ids.size() == 1 ? 0 : 1; i < ids.size(); ++i) {
    const auto leg = FindLaneletRoute(map.lanelets(), at, map.DirectionsOf(ids[i]));
    if (!leg) {
      Refuse(file, "lanelets",
             fmt::format("no lanelets that follow each other and no dashed lines lead from lanelet "
                         "{} to lanelet {}",
                         ids[i - 1], ids[i]));
    }
    for (std::size_t k = 0; k < leg->size(); ++k) {
      if (k > 0) {
        route.lanes.emplace_back();
      }
      LaneletLane& lane = route.lanes.back();
      // The first lanelet of a leg is the last one of the leg before.
      const bool continues = k == 0 && !lane.empty();
      lane.insert(lane.end(), (*leg)[k].begin() + (continues ? 1 : 0), (*leg)[k].end());
    }
    at = {names.at(route.lanes.back().back())};
  }
  for (const LaneletLane& lane : route.lanes) {
    for (const Lanelet* lanelet : lane) {
      route.keys[lanelet] = names.at(lanelet);
    }
  }
  return route;
}

/// Adds points on long steps beside short ones, so that each step is at most about twice as long as
/// its neighbors. The center of a lanelet is a polyline; with the added points, a spline stays
/// close to the straight lines of the polyline.
std::vector<Vec2> Graded(const std::vector<Vec2>& points) {
  const auto step = [&](std::size_t i) { return (points[i + 1] - points[i]).norm(); };
  std::vector<Vec2> graded;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double length = step(i);
    const double before = i > 0 ? step(i - 1) : length;
    const double after = i + 2 < points.size() ? step(i + 1) : length;
    // Distances of the added points from the start of the step [m].
    std::vector<double> places{0.0};
    for (double next = 2.0 * before; places.back() + next < 0.5 * length; next *= 2.0) {
      places.push_back(places.back() + next);
    }
    std::vector<double> from_end{0.0};
    for (double next = 2.0 * after; from_end.back() + next < 0.5 * length; next *= 2.0) {
      from_end.push_back(from_end.back() + next);
    }
    std::for_each(from_end.rbegin(), from_end.rend() - 1,
                  [&](double s) { places.push_back(length - s); });
    for (const double s : places) {
      graded.push_back(points[i] + s / length * (points[i + 1] - points[i]));
    }
  }
  graded.push_back(points.back());
  return graded;
}

/// Returns the points along the centers of a route: those of the lanelets, or, if the route changes
/// lanes, points 1 m apart.
std::vector<Vec2> PointsOf(const Lanelet2Map& map, const Lanelet2Route& route) {
  constexpr double kChangeSpeed = 14.0;  // Speed [m/s] at which a lane change of 3.5 m takes 51 m.
  constexpr double kApart = 1e-3;        // Smallest distance of two path points [m].
  constexpr double kShortest = 0.3;      // Shortest last step of a route that changes lanes [m].
  const LaneletLane& last = route.lanes.back();
  std::vector<Vec2> points;
  const auto add = [&](const Vec2& point) {
    if (points.empty() || (point - points.back()).norm() > kApart) {
      points.push_back(point);
    }
  };
  if (route.lanes.size() == 1) {
    for (const Lanelet* lanelet : last) {
      std::for_each(lanelet->center.begin(), lanelet->center.end(), add);
    }
    return points.empty() ? points : Graded(points);
  }
  const std::vector<Vec2>& center = route.lanes.front().front()->center;
  const Vec2 step = center[1] - center[0];
  const Pose2 start{center[0].x(), center[0].y(), std::atan2(step.y(), step.x())};
  points = LaneletPath(map.lanelets(), route.lanes, start, std::nullopt, kChangeSpeed, 0.0);
  while (points.size() > 1 && (points.back() - last.back()->center.back()).norm() < kShortest) {
    points.pop_back();
  }
  points.push_back(last.back()->center.back());
  return points;
}

/// Returns the speed limit at each point; empty if no lanelet of the route has one.
std::vector<double> LimitsOf(const Lanelet2Map& map, const Lanelet2Route& route,
                             const std::vector<Vec2>& points) {
  std::vector<const Lanelet*> all;
  for (const LaneletLane& lane : route.lanes) {
    all.insert(all.end(), lane.begin(), lane.end());
  }
  const auto limit = [&](std::size_t i) { return map.Directed(route.keys.at(all[i])).limit; };
  const bool has_limit = std::any_of(all.begin(), all.end(), [&](const Lanelet* lanelet) {
    return map.Directed(route.keys.at(lanelet)).has_limit;
  });
  std::vector<double> limits;
  std::size_t at = 0;
  for (const Vec2& point : points) {
    if (!has_limit) {
      break;
    }
    double here = limit(at);
    while (at + 1 < all.size()) {
      const double away = PlaceOn(all[at]->center, point).distance;
      const double next = PlaceOn(all[at + 1]->center, point).distance;
      if (next > away + 1e-6) {
        break;
      }
      ++at;
      here = std::min(here, limit(at));
    }
    limits.push_back(here);
  }
  return limits;
}

}  // namespace

PathFile ReadLanelet2(const fs::path& file, const std::string& text, const PathMap& map) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    Refuse(file, "", XmlProblem(text, document.ErrorName()), document.ErrorLineNum());
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "osm") {
    Refuse(file, "", "the root element must be osm", root == nullptr ? 1 : root->GetLineNum());
  }
  const Lanelet2Map own(file, *root, map);
  if (own.lanelets().empty()) {
    Refuse(file, "", "no lanelet for cars in the file: relations with the tag type=lanelet");
  }
  if (map.lanelets.empty()) {
    Refuse(
        file, "lanelets",
        "missing; name the first and the last lanelet of the route, such as lanelets: [10, 14]: " +
            own.Some());
  }
  const Lanelet2Route route = RouteOf(file, own, map.lanelets);
  double length = 0.0;
  std::vector<std::string> ids;
  for (const LaneletLane& lane : route.lanes) {
    for (const Lanelet* lanelet : lane) {
      length += lanelet->Length();
      ids.push_back(route.keys.at(lanelet));
    }
  }
  if (length > kMaxRouteLength) {
    Refuse(file, "lanelets",
           fmt::format("the route would be {:.4g} km long; must be at most {:.0f} km",
                       1e-3 * length, 1e-3 * kMaxRouteLength));
  }
  PathFile found;
  found.points.points = PointsOf(own, route);
  found.points.speed = LimitsOf(own, route, found.points.points);
  found.lanes = DrawnLanesOf(own.lanelets(), found.points.points);
  constexpr std::size_t kNamed = 20;
  const std::size_t count = ids.size();
  ids.resize(std::min(count, kNamed));
  found.notes.push_back(fmt::format("Lanelet2, centers of {} lanelets: {}{}", count,
                                    fmt::join(ids, ", "), count > kNamed ? ", ..." : ""));
  found.notes.insert(found.notes.end(), own.notes().begin(), own.notes().end());
  if (!found.points.speed.empty()) {
    found.notes.emplace_back("speeds are the speed limits of the lanelets");
  }
  return found;
}

}  // namespace trackbed

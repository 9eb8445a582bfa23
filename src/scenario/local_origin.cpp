#include "src/scenario/local_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "src/scenario/diagnostics.h"
#include "src/scenario/place_visitor.h"
#include "src/scenario/route_world.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/recording/recorded_drive.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/track/track.h"

// Moves a scenario to its local origin. The function Visit of a scenario declares which keys are
// coordinates (map_range.h). PlaceVisitor finds all keys that are coordinates (place_visitor.h).
// Further coordinates are in files that the scenario names: record, track, map, road network, and
// path. The local origin is the middle of the bounding box of all places. The origin's coordinates
// are whole meters, so that subtracting the origin from a coordinate and adding it again yields
// exactly the same number.
namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The coordinates of an automatically chosen origin are multiples of this distance [m].
constexpr double kOriginStep = 1000.0;

/// The smallest axis-aligned rectangle around some points. If no point has a coordinate along an
/// axis, `low` exceeds `high` along this axis.
struct Bounds2 {
  Vec2 low{kInfinity, kInfinity};
  Vec2 high{-kInfinity, -kInfinity};

  void Include(MapAxis axis, double value) {
    const int i = axis == MapAxis::kX ? 0 : 1;
    low[i] = std::min(low[i], value);
    high[i] = std::max(high[i], value);
  }
  void Include(const Vec2& point) {
    Include(MapAxis::kX, point.x());
    Include(MapAxis::kY, point.y());
  }
  void Include(const Bounds2& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  /// Returns the distance between the rectangle and a point along x or along y, whichever is larger
  /// [m]; 0 for a point in the rectangle.
  [[nodiscard]] double DistanceFrom(const Vec2& point) const {
    double distance = 0.0;
    for (int i = 0; i < 2; ++i) {
      if (low[i] <= high[i]) {
        distance = std::max({distance, low[i] - point[i], point[i] - high[i]});
      }
    }
    return distance;
  }
  /// Returns whether the magnitude of a coordinate of the rectangle exceeds kOriginReach.
  [[nodiscard]] bool IsFar() const {
    return low.minCoeff() < -kOriginReach || high.maxCoeff() > kOriginReach;
  }
  [[nodiscard]] Vec2 Middle() const {
    const auto middle = [&](int i) { return low[i] <= high[i] ? 0.5 * (low[i] + high[i]) : 0.0; };
    return {middle(0), middle(1)};
  }
};

/// A site, a group of places that belong together: the places of one key, or the places in one
/// file.
struct Site {
  std::string key;
  std::string name;
  Bounds2 bounds;
};

/// Formats the coordinates of a point with two decimals.
std::string Show(const Vec2& point) {
  return fmt::format("({:.2f}, {:.2f})", point.x(), point.y());
}

std::vector<Site> SitesOfKeys(Scenario& scenario) {
  std::map<std::string, Bounds2> sites;
  PlaceVisitor visitor([&](const std::string& place, MapAxis axis, double& value) {
    sites[place].Include(axis, value);
  });
  Visit(visitor, scenario);
  std::vector<Site> found;
  for (const auto& [place, bounds] : sites) {
    // SitesOfFiles adds the start of the car, with the default values of missing start coordinates.
    if (place != "mission.start") {
      found.push_back({place, place, bounds});
    }
  }
  return found;
}

template <typename Points>
Bounds2 BoundsOf(const Points& points) {
  Bounds2 bounds;
  for (const Vec2& point : points) {
    bounds.Include(point);
  }
  return bounds;
}

bool HasRoute(const Scenario& scenario) {
  const auto& roads = scenario.world.road_network;
  const std::vector<LanePlace>& route = scenario.mission.route;
  return roads && roads->data && !route.empty() &&
         std::all_of(route.begin(), route.end(), [&](const LanePlace& place) {
           return LanePlaceError(roads->data->network, place).empty();
         });
}

/// Returns the places in the contents of files, except for the roads.
std::vector<Site> SitesOfFiles(const Scenario& scenario) {
  std::vector<Site> sites;
  if (scenario.record && scenario.record->data) {
    Bounds2 bounds;
    for (const RecordedSample& sample : scenario.record->data->samples) {
      bounds.Include(sample.pose.position());
    }
    sites.push_back({"record.file", "the record " + scenario.record->file, bounds});
  }
  if (scenario.record && scenario.record->ground_data) {
    Bounds2 bounds;
    for (const TrackPoint& point : scenario.record->ground_data->points) {
      bounds.Include(point.position);
    }
    sites.push_back({"record.ground", "the ground " + *scenario.record->ground, bounds});
  }
  if (const auto& track = scenario.mission.track; track && track->data) {
    Bounds2 bounds;
    for (const TrackPoint& point : track->data->points()) {
      bounds.Include(point.position);
    }
    sites.push_back({"mission.track.file", "the track " + track->file, bounds});
  }
  if (const auto& map = scenario.world.map; map && map->data) {
    sites.push_back({"world.map.file", "the map " + map->file,
                     BoundsOf(std::array{map->data->map().X_WM.position()})});
  }
  if (scenario.plan) {
    const PlannerEntry& planner = PlannerFor(scenario.plan->global);
    if (planner.places != nullptr) {
      sites.push_back({PlannerSection(scenario) + "file",
                       fmt::format("the file of the planner {}", planner.name),
                       BoundsOf(planner.places(scenario.plan->global))});
    }
  }
  const StartSpec& start = scenario.mission.start;
  if (!HasRoute(scenario) || (start.x && start.y)) {
    sites.push_back({"mission.start", start.x || start.y ? "mission.start" : "the start of the car",
                     BoundsOf(std::array{InitialState(scenario).pose.position()})});
  }
  return sites;
}

Bounds2 BoundsOfRoute(const Scenario& scenario) {
  Bounds2 bounds;
  for (const LanePlace& place : scenario.mission.route) {
    bounds.Include(PoseAt(scenario.world.road_network->data->network, place).position());
  }
  return bounds;
}

Bounds2 BoundsOfRoads(const RoadNetwork& network) {
  Bounds2 bounds;
  for (const auto& [id, road] : network.roads) {
    for (const ReferenceLine::Piece& piece : road.reference.pieces()) {
      bounds.Include(piece.start.position());
    }
  }
  return bounds;
}

Bounds2 Moved(Bounds2 bounds, const Vec2& by) {
  return {bounds.low + by, bounds.high + by};
}

/// Returns the offset in the OpenDRIVE header if the roads are near `place` only after adding this
/// offset; otherwise (0, 0).
Vec2 OffsetNear(const OpenDriveFile& file, const Bounds2& roads, const Vec2& place) {
  const bool is_near = roads.DistanceFrom(place) <= kOriginReach + kOriginStep;
  const bool is_usable = file.offset != Vec2::Zero() && file.offset_heading == 0.0;
  return !is_near && is_usable &&
                 Moved(roads, file.offset).DistanceFrom(place) <= kOriginReach + kOriginStep
             ? file.offset
             : Vec2(Vec2::Zero());
}

/// Returns the key and the error message for places of a scenario that are too far from each other.
/// The error message names the two places whose coordinates differ most in x or y.
std::pair<std::string, std::string> MixedProblem(const std::vector<Site>& sites) {
  const Site* near = &sites.front();
  const Site* far = &sites.front();
  double most = -1.0;
  for (int i = 0; i < 2; ++i) {
    const auto lower = std::min_element(
        sites.begin(), sites.end(),
        [&](const Site& a, const Site& b) { return a.bounds.high[i] < b.bounds.high[i]; });
    const auto upper = std::max_element(
        sites.begin(), sites.end(),
        [&](const Site& a, const Site& b) { return a.bounds.low[i] < b.bounds.low[i]; });
    if (const double apart = upper->bounds.low[i] - lower->bounds.high[i]; apart > most) {
      most = apart;
      near = &*lower;
      far = &*upper;
    }
  }
  if (near->bounds.DistanceFrom(Vec2::Zero()) > far->bounds.DistanceFrom(Vec2::Zero())) {
    std::swap(near, far);
  }
  return {near->key,
          fmt::format("{} is at {}, but {} is at {}, {:.4g} m away; all places of a scenario must "
                      "be within {:g} m of one origin: give both in the same coordinates",
                      near->name, Show(near->bounds.Middle()), far->name,
                      Show(far->bounds.Middle()), most, kOriginReach)};
}

void TranslateFiles(Scenario& scenario, const Vec2& by) {
  if (scenario.record && scenario.record->data) {
    auto moved = std::make_shared<RecordedDrive>(*scenario.record->data);
    for (RecordedSample& sample : moved->samples) {
      sample.pose.x += by.x();
      sample.pose.y += by.y();
    }
    scenario.record->data = std::move(moved);
  }
  if (scenario.record && scenario.record->ground_data) {
    auto moved = std::make_shared<BankedTrack>(*scenario.record->ground_data);
    for (TrackPoint& point : moved->points) {
      point.position += by;
    }
    scenario.world.ground.terrain = MakeTerrain(*moved);
    scenario.record->ground_data = std::move(moved);
  }
  if (auto& track = scenario.mission.track; track && track->data) {
    track->data = std::make_shared<const Track>(Moved(*track->data, by));
  }
  if (auto& map = scenario.world.map; map && map->data) {
    GridMap moved = map->data->map();
    moved.X_WM.x += by.x();
    moved.X_WM.y += by.y();
    map->data = std::make_shared<const MapObstacles>(std::move(moved), map->unknown);
  }
  if (scenario.plan) {
    const PlannerEntry& planner = PlannerFor(scenario.plan->global);
    if (planner.translate != nullptr) {
      planner.translate(scenario.plan->global, by);
    }
  }
}

template <typename Struct>
void TranslateKeys(Struct& value, const Vec2& by) {
  PlaceVisitor visitor([&](const std::string&, MapAxis axis, double& coordinate) {
    coordinate += axis == MapAxis::kX ? by.x() : by.y();
  });
  Visit(visitor, value);
}

/// Moves the scenario to a local origin. Writes the coordinates of the start into the scenario if
/// its start would otherwise differ from that of the resolved scenario. The two starts would differ
/// in two cases: a start at the default (0, 0), and a start on a fitted curve. A start on a fitted
/// curve is rounded to coordinates that the resolved scenario can state.
void Move(Scenario& scenario, const Vec2& origin) {
  const Vec2 before = InitialState(scenario).pose.position();
  TranslateKeys(scenario, -origin);
  TranslateFiles(scenario, -origin);
  if (auto& roads = scenario.world.road_network; roads && roads->data) {
    roads->data = std::make_shared<const OpenDriveFile>(RoadsFrom(*roads->data, origin));
    if (scenario.world.ground.terrain && !(scenario.record && scenario.record->ground_data)) {
      AddRouteGround(scenario.mission.route, scenario.world);
    }
  }
  // If the start is at the default (0, 0), TranslateKeys has not moved it, because this start does
  // not depend on any place of the scenario.
  const Vec2 after = InitialState(scenario).pose.position();
  const bool is_default = after == before && !HasRoute(scenario);
  const Vec2 start = is_default ? Vec2(after - origin) : after;
  const Vec2 stated = (start + origin) - origin;
  if (stated != after) {
    scenario.mission.start.x = stated.x();
    scenario.mission.start.y = stated.y();
  }
}

}  // namespace

Track Moved(const Track& track, const Vec2& by) {
  std::vector<TrackPoint> points = track.points();
  for (TrackPoint& point : points) {
    point.position += by;
  }
  return Track(std::move(points), track.smoothing());
}

std::optional<std::pair<std::string, std::string>> MoveToLocalOrigin(Scenario& scenario) {
  std::vector<Site> sites = SitesOfKeys(scenario);
  for (Site& site : SitesOfFiles(scenario)) {
    sites.push_back(std::move(site));
  }
  // Drop keys with only one coordinate: they belong to a map or to the start, which are separate
  // sites.
  std::erase_if(sites, [](const Site& site) {
    return !(site.bounds.low.array() <= site.bounds.high.array()).all();
  });
  Bounds2 all;
  for (const Site& site : sites) {
    all.Include(site.bounds);
  }
  if (HasRoute(scenario)) {
    const OpenDriveFile& file = *scenario.world.road_network->data;
    Bounds2 route = BoundsOfRoute(scenario);
    if (scenario.origin || !sites.empty()) {
      route = Moved(route, OffsetNear(file, route, scenario.origin.value_or(all.Middle())));
    }
    sites.push_back(
        {"world.road_network", "the route on " + scenario.world.road_network->file, route});
    all.Include(route);
  }
  if (!scenario.origin && !all.IsFar()) {
    return std::nullopt;
  }
  const Vec2 middle = all.Middle() / kOriginStep;
  const Vec2 origin =
      scenario.origin.value_or(kOriginStep * Vec2(std::round(middle.x()), std::round(middle.y())));
  const auto is_elsewhere = [&](const Site& site) {
    return site.bounds.DistanceFrom(origin) > kOriginReach + kOriginStep;
  };
  if (const auto found = std::find_if(sites.begin(), sites.end(), is_elsewhere);
      found != sites.end()) {
    if (!scenario.origin) {
      return MixedProblem(sites);
    }
    return std::pair(
        found->key,
        fmt::format("{} is at {}, {:.4g} m from the origin {}; must be within {:g} m: set another "
                    "origin, or give both in the same coordinates",
                    found->name, Show(found->bounds.Middle()), found->bounds.DistanceFrom(origin),
                    Show(origin), kOriginReach));
  }
  scenario.origin = origin;
  if (origin != Vec2::Zero()) {
    Move(scenario, origin);
  }
  return std::nullopt;
}

Scenario InFileCoordinates(const Scenario& scenario, bool with_files) {
  Scenario moved = scenario;
  if (const Vec2 origin = OriginOf(scenario); origin != Vec2::Zero()) {
    TranslateKeys(moved, origin);
    if (with_files) {
      TranslateFiles(moved, origin);
    }
  }
  return moved;
}

Vec2 ReadOrigin(const std::filesystem::path& file) {
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  YamlReader reader(context, LoadYaml(ReadInput(file), file.string()), "");
  std::optional<Vec2> origin;
  VisitOrigin(reader, origin);
  if (!context.problems.empty()) {
    throw InputError(context.problems);
  }
  return origin.value_or(Vec2::Zero());
}

void MoveToOrigin(World& world, const Vec2& origin) {
  if (origin == Vec2::Zero()) {
    return;
  }
  Scenario around;
  around.world = std::move(world);
  around.plan.reset();
  TranslateKeys(around.world, -origin);
  TranslateFiles(around, -origin);
  world = std::move(around.world);
}

OpenDriveFile RoadsFrom(OpenDriveFile roads, const Vec2& origin) {
  if (origin != Vec2::Zero()) {
    const Vec2 offset = OffsetNear(roads, BoundsOfRoads(roads.network), origin);
    roads = ParseOpenDriveFile(std::move(roads.text), "", origin - offset);
  }
  return roads;
}

}  // namespace trackbed

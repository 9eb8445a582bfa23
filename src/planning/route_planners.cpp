#include "src/planning/route_planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/planning/astar.h"
#include "trackbed/planning/clear_way.h"
#include "trackbed/planning/curvature_steps.h"
#include "trackbed/planning/dubins.h"
#include "trackbed/planning/reeds_shepp.h"

namespace trackbed {
namespace {

std::string FirstCorner(const std::vector<Vec2>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 in = points[i] - points[i - 1];
    const Vec2 out = points[i + 1] - points[i];
    const double turn = std::atan2(Cross(in, out), in.dot(out));
    if (std::abs(turn) > 1e-6) {
      return fmt::format("the heading jumps by {:.3g} rad at ({:.4g}, {:.4g}); no car drives that",
                         turn, points[i].x(), points[i].y());
    }
  }
  return "";
}

}  // namespace

namespace route {

Plan Refused(PlanStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

Plan CheckRoute(const PlanRequest& request) {
  if (request.waypoints.size() < 2) {
    return Refused(
        PlanStatus::kTooFewWaypoints,
        fmt::format("{} waypoints; a start and a goal are needed", request.waypoints.size()));
  }
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    if (request.waypoints[i] == request.waypoints[i - 1]) {
      return Refused(PlanStatus::kDuplicateWaypoints,
                     fmt::format("waypoint {} is the one before it", i));
    }
  }
  if (request.waypoints[1] == request.start.position()) {
    return Refused(PlanStatus::kDuplicateWaypoints, "the car stands at waypoint 1");
  }
  return {};
}

void Complete(Plan& plan, const PlanRequest& request) {
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtCusps(path, request.start_speed, request.speed, plan.caps);
  plan.schedule_speed = plan.reference.speed;
  plan.schedule = CourseSchedule(request.vehicle, path.segments(), plan.reference.speed);
  plan.goal = path.At(path.length()).pose;
  plan.diagnostics["turns"] = nlohmann::json::array();
  plan.diagnostics["changes_of_direction"] = LegsOf(path).size() - 1;
}

Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed) {
  if (corners == Corners::kRefuse) {
    if (const std::string corner = FirstCorner(points); !corner.empty()) {
      return Refused(PlanStatus::kTurnTooTight, corner);
    }
  }
  RoundedCorners rounded =
      RoundCorners(request.vehicle, points,
                   {.speed = request.speed.speed,
                    .min_speed = std::min(min_speed, request.speed.speed),
                    .max_curvature = 1.0 / request.vehicle.min_turning_radius()},
                   ClearWay(request.vehicle, request.obstacles, safe_distance));
  if (rounded.status != PlanStatus::kOk) {
    return Refused(rounded.status, rounded.reason);
  }
  plan.diagnostics["corners"] = nlohmann::json::array();
  for (const RoundCorner& corner : rounded.corners) {
    plan.diagnostics["corners"].push_back({{"at_m", {corner.at.x(), corner.at.y()}},
                                           {"heading_change_rad", corner.heading_change},
                                           {"speed_mps", corner.speed},
                                           {"curvature_radpm", corner.curvature},
                                           {"tangent_length_m", corner.tangent_length},
                                           {"from_s_m", corner.from},
                                           {"to_s_m", corner.to}});
  }
  plan.reference.path = std::move(rounded.path);
  plan.caps = std::move(rounded.caps);
  Complete(plan, request);
  return plan;
}

nlohmann::json ToJson(const std::vector<Vec2>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const Vec2& point : points) {
    list.push_back({point.x(), point.y()});
  }
  return list;
}

}  // namespace route

namespace {

using route::CheckRoute;
using route::Complete;
using route::Refused;

/// The radius to plan with, or why there is none.
Plan CheckRadius(const VehicleParams& vehicle, const std::optional<double>& radius) {
  if (radius && *radius < vehicle.min_turning_radius()) {
    return Refused(PlanStatus::kTurnTooTight,
                   fmt::format("a radius of {:.4g} m; the car turns on {:.4g} m or more", *radius,
                               vehicle.min_turning_radius()));
  }
  return {};
}

double RadiusFor(const VehicleParams& vehicle, const std::optional<double>& radius) {
  return radius.value_or(1.1 * vehicle.min_turning_radius());
}

/// Whether the car can stand at every stop.
Plan CheckStops(const std::vector<Pose2>& stops, const ClearWay& clear) {
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!clear.IsFree(stops[i])) {
      const std::string place = fmt::format("({:.4g}, {:.4g})", stops[i].x, stops[i].y);
      return i == 0
                 ? Refused(PlanStatus::kStartBlocked,
                           "the car stands too near to an obstacle at " + place)
                 : Refused(PlanStatus::kGoalBlocked,
                           fmt::format("an obstacle is too near to waypoint {} at {}", i, place));
    }
  }
  return {};
}

bool IsFree(const ClearWay& clear, Pose2 pose, const std::vector<Segment>& segments) {
  return !clear.FirstBlocked(Path(pose, segments));
}

/// Plans from stop to stop by the first of `words` that is free.
template <typename Options, typename Words>
Plan PlanCurves(const Options& options, const PlanRequest& request, const Words& words) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  const double radius = RadiusFor(request.vehicle, options.radius);
  const ClearWay clear(request.vehicle, request.obstacles, options.safe_distance);
  const std::vector<Pose2> stops = StopsOf(request);
  if (Plan refused = CheckStops(stops, clear); !refused.ok()) {
    return refused;
  }
  Plan plan;
  plan.diagnostics["curves"] = nlohmann::json::array();
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const std::vector<ShortestCurve> all = words(stops[i - 1], stops[i], radius);
    const bool rolls = i == 1 && request.start_speed > 0.0;
    const auto free = std::find_if(all.begin(), all.end(), [&](const ShortestCurve& curve) {
      const std::vector<Segment> own = SegmentsOf(curve);
      const bool backwards = !own.empty() && own.front().direction < 0;
      return !(rolls && backwards) && IsFree(clear, stops[i - 1], own);
    });
    if (free == all.end()) {
      return Refused(PlanStatus::kNoPath,
                     fmt::format("none of the {} curves to waypoint {} is free of obstacles{}",
                                 all.size(), i, rolls ? " and begins as the car rolls" : ""));
    }
    const std::vector<Segment> own = SegmentsOf(*free);
    segments.insert(segments.end(), own.begin(), own.end());
    plan.diagnostics["curves"].push_back({{"word", WordOf(*free)},
                                          {"length_m", free->length},
                                          {"radius_m", radius},
                                          {"shorter_ones_blocked", free - all.begin()}});
  }
  plan.caps = CapsOfSteps(request.vehicle, segments, options.min_speed);
  plan.reference.path = Path(request.start, std::move(segments));
  Complete(plan, request);
  return plan;
}

PlanStatus StatusOf(GridStatus status) {
  switch (status) {
    case GridStatus::kFound:
      return PlanStatus::kOk;
    case GridStatus::kStartOccupied:
      return PlanStatus::kStartBlocked;
    case GridStatus::kGoalOccupied:
      return PlanStatus::kGoalBlocked;
    case GridStatus::kUnreachable:
      return PlanStatus::kNoPath;
    case GridStatus::kBudgetUsedUp:
      return PlanStatus::kBudgetUsedUp;
  }
  return PlanStatus::kNoPath;
}

/// The middles of the cells, with the stops themselves at the ends.
std::vector<Vec2> PointsOf(const OccupancyGrid& grid, const GridPath& way, const Vec2& goal) {
  std::vector<Vec2> points;
  for (const std::size_t cell : way.cells) {
    points.push_back(grid.MiddleOf(cell));
  }
  if ((points.back() - goal).norm() > 1e-9 * grid.cell) {
    points.push_back(goal);
  } else {
    points.back() = goal;
  }
  return points;
}

}  // namespace

std::vector<Pose2> StopsOf(const PlanRequest& request) {
  const std::vector<Vec2>& points = request.waypoints;
  std::vector<Pose2> stops{request.start};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 before = stops.back().position();
    const Vec2 along = points[std::min(i + 1, points.size() - 1)] - before;
    stops.push_back(
        {points[i].x(), points[i].y(),
         request.headings.empty() ? std::atan2(along.y(), along.x()) : request.headings[i]});
  }
  return stops;
}

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request) {
  return PlanCurves(options, request, DubinsWords);
}

Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request) {
  // Every word to a pose may begin backwards, which a car that rolls cannot; Dubins' do not.
  return PlanCurves(options, request, [](const Pose2& from, const Pose2& to, double radius) {
    std::vector<ShortestCurve> words = ReedsSheppWords(from, to, radius);
    const std::vector<ShortestCurve> forwards = DubinsWords(from, to, radius);
    words.insert(words.end(), forwards.begin(), forwards.end());
    std::stable_sort(
        words.begin(), words.end(),
        [](const ShortestCurve& a, const ShortestCurve& b) { return a.length < b.length; });
    return words;
  });
}

Plan PlanWith(const AStarOptions& options, const PlanRequest& request) {
  if (Plan refused = CheckRoute(request); !refused.ok()) {
    return refused;
  }
  const bool round = options.corners == Corners::kRound;
  const double inflation =
      0.5 * request.vehicle.width + options.safe_distance + (round ? options.corner_room : 0.0);
  // What is free all over a cell, and on the way from its middle to the next one's.
  const double over_a_cell = 0.5 * std::sqrt(2.0) * options.cell;
  std::vector<Vec2> stops = request.waypoints;
  stops.front() = request.start.position();
  const GridArea area = AreaAround(request.start, stops, request.obstacles, options.margin);
  if (CellsIn(area, options.cell) > kMostCells) {
    return Refused(PlanStatus::kBudgetUsedUp,
                   fmt::format("{:.3g} cells of {:.3g} m; at most {:.3g} are searched",
                               CellsIn(area, options.cell), options.cell, kMostCells));
  }
  const OccupancyGrid grid =
      RasterOf(request.start, area, options.cell, request.obstacles, inflation + over_a_cell);
  std::vector<Vec2> points{request.start.position()};
  Plan plan;
  plan.diagnostics["legs"] = nlohmann::json::array();
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    const Vec2 goal = request.waypoints[i];
    const int from = grid.CellAt(points.back());
    const int to = grid.CellAt(goal);
    const GridPath way = SearchGrid(grid, static_cast<std::size_t>(from),
                                    static_cast<std::size_t>(to), options.budget);
    if (!way.ok()) {
      const PlanStatus status = StatusOf(way.status);
      return Refused(status, fmt::format("from waypoint {} to {}: {}, after {} cells of {:.3g} m; "
                                         "obstacles are inflated by {:.3g} m",
                                         i - 1, i, ToString(way.status), way.expansions,
                                         options.cell, inflation + over_a_cell));
    }
    std::vector<Vec2> leg = PointsOf(grid, way, goal);
    leg.front() = points.back();
    plan.diagnostics["legs"].push_back({{"cost_m", way.cost * options.cell},
                                        {"expansions", way.expansions},
                                        {"cells", grid.size()},
                                        {"path_m", route::ToJson(WithoutStraightOn(leg))}});
    if (round) {
      leg = Shortcut(leg, request.obstacles, inflation);
    }
    points.insert(points.end(), leg.begin() + 1, leg.end());
  }
  if (!round) {
    points = WithoutStraightOn(points);
  }
  return route::AlongPolyline(std::move(plan), request, points, options.corners,
                              options.safe_distance, options.min_speed);
}

Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  const std::vector<Pose2> stops = StopsOf(request);
  Plan plan;
  plan.diagnostics["legs"] = nlohmann::json::array();
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const HybridAStarResult found =
        SearchHybridAStar(request.vehicle,
                          {.start = stops[i - 1],
                           .goal = stops[i],
                           .obstacles = request.obstacles,
                           .rolls = i == 1 && request.start_speed > 0.0},
                          options);
    if (!found.ok()) {
      return Refused(found.status,
                     fmt::format("from waypoint {} to {}: {}", i - 1, i, found.reason));
    }
    segments.insert(segments.end(), found.segments.begin(), found.segments.end());
    plan.diagnostics["legs"].push_back(
        {{"cost_m", found.cost}, {"expansions", found.expansions}, {"cells", found.cells}});
  }
  plan.caps = CapsOfSteps(request.vehicle, segments, options.min_speed);
  plan.reference.path = Path(request.start, std::move(segments));
  Complete(plan, request);
  return plan;
}

}  // namespace trackbed

#include "src/planning/route_planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/planning/lead_in.h"
#include "trackbed/planning/astar.h"
#include "trackbed/planning/clear_way.h"
#include "trackbed/planning/curvature_steps.h"
#include "trackbed/planning/dubins.h"
#include "trackbed/planning/feasibility.h"
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
  SetSpeeds(plan, request.start_speed, request.speed);
  plan.schedule =
      CourseSchedule(request.vehicle, path.segments(), request.speed.speed, plan.caps, plan.stops);
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
                    .max_curvature = 1.0 / request.vehicle.min_turning_radius(),
                    .start_speed = request.start_speed,
                    .deceleration = request.speed.deceleration},
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

/// A plan along arcs and straights.
Plan AlongSegments(Plan plan, const PlanRequest& request, std::vector<Segment> segments,
                   double min_speed) {
  StepSpeeds steps = PlanSteps(request.vehicle, segments, min_speed);
  plan.caps = std::move(steps.caps);
  plan.stops = std::move(steps.stops);
  plan.reference.path = Path(request.start, std::move(segments));
  Complete(plan, request);
  if (!plan.stops.empty()) {
    plan.diagnostics["stops_m"] = plan.stops;
  }
  return plan;
}

bool IsFree(const ClearWay& clear, Pose2 pose, const std::vector<Segment>& segments) {
  return !clear.FirstBlocked(Path(pose, segments));
}

/// One way from a pose to a stop, and where it begins.
struct FoundCurve {
  std::vector<Segment> segments;
  ShortestCurve curve;
  std::ptrdiff_t shorter_ones_blocked = 0;
  double cost = 0.0;  // [m]
};

/// The shortest of `words` that is free and begins as it may, a stop counting as so many metres.
template <typename MayBegin>
std::optional<FoundCurve> FirstFree(const PlanRequest& request, const ClearWay& clear,
                                    const Pose2& from, const std::vector<ShortestCurve>& words,
                                    double min_speed, const MayBegin& may_begin) {
  constexpr double kStop = 5.0;  // [m]; as changes of direction cost hybrid A*
  std::vector<FoundCurve> candidates;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::vector<Segment> own = SegmentsOf(words[i]);
    if (may_begin(own)) {
      const auto stops =
          static_cast<double>(PlanSteps(request.vehicle, own, min_speed).stops.size());
      candidates.push_back({std::move(own), words[i], static_cast<std::ptrdiff_t>(i),
                            words[i].length + kStop * stops});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.cost < b.cost; });
  const auto free =
      std::find_if(candidates.begin(), candidates.end(),
                   [&](const FoundCurve& curve) { return IsFree(clear, from, curve.segments); });
  return free == candidates.end() ? std::nullopt : std::optional(std::move(*free));
}

/// Where a rolling car's curves begin: after it has slowed down for the first step of curvature.
LeadIn LeadInForCurves(const PlanRequest& request, double radius, double min_speed) {
  const double curvature = 1.0 / radius;
  const double speed = std::max(StepSpeed(request.vehicle, 0.0, curvature), min_speed);
  return LeadInOf(request, std::min(speed, request.start_speed),
                  0.5 * SteeringDistance(request.vehicle,
                                         SteeringForCurvature(request.vehicle, curvature), speed));
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
  const auto any = [](const std::vector<Segment>&) { return true; };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const bool rolls = i == 1 && request.start_speed > 0.0;
    std::vector<ShortestCurve> all = words(stops[i - 1], stops[i], radius);
    std::optional<FoundCurve> found;
    if (rolls) {
      // At once, if the wheels stand right for it, or after a lead-in; whichever is shorter.
      const double bend = CurvatureForSteering(request.vehicle, request.start_steering);
      found = FirstFree(request, clear, stops[0], all, options.min_speed, [&](const auto& own) {
        constexpr double kSame = 1e-6;  // [1/m]
        return !own.empty() && own.front().direction > 0 &&
               std::abs(own.front().curvature - bend) < kSame;
      });
      const LeadIn lead = LeadInForCurves(request, radius, options.min_speed);
      const auto forwards = [](const std::vector<Segment>& own) {
        return own.empty() || own.front().direction > 0;
      };
      std::optional<FoundCurve> later;
      if (IsFree(clear, stops[0], lead.segments)) {
        later = FirstFree(request, clear, lead.end, words(lead.end, stops[1], radius),
                          options.min_speed, forwards);
      }
      if (later && (!found || lead.length + later->cost < found->cost)) {
        later->segments.insert(later->segments.begin(), lead.segments.begin(), lead.segments.end());
        found = std::move(later);
      }
    } else {
      found = FirstFree(request, clear, stops[i - 1], all, options.min_speed, any);
    }
    if (!found) {
      return Refused(
          PlanStatus::kNoPath,
          fmt::format("none of the {} curves to waypoint {} is free of obstacles{}", all.size(), i,
                      rolls ? " and begins as the car rolls; a car at rest "
                              "(mission.start.speed: 0) has more"
                            : ""));
    }
    segments.insert(segments.end(), found->segments.begin(), found->segments.end());
    plan.diagnostics["curves"].push_back({{"word", WordOf(found->curve)},
                                          {"length_m", found->curve.length},
                                          {"radius_m", radius},
                                          {"shorter_ones_blocked", found->shorter_ones_blocked}});
  }
  return AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
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

/// What must be free besides for all of a cell to be, and the way from its middle to the next [m].
double OverACell(const AStarOptions& options) {
  return 0.5 * std::sqrt(2.0) * options.cell;
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

namespace {

/// A* from the last of some points on to all waypoints but the first.
Plan PlanGrid(const AStarOptions& options, const PlanRequest& request, const OccupancyGrid& grid,
              double inflation, std::vector<Vec2> points) {
  const bool round = options.corners == Corners::kRound;
  Plan plan;
  plan.diagnostics["legs"] = nlohmann::json::array();
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    const Vec2 goal = request.waypoints[i];
    const int from = grid.CellAt(points.back());
    const int to = grid.CellAt(goal);
    const GridPath way = SearchGrid(grid, static_cast<std::size_t>(from),
                                    static_cast<std::size_t>(to), options.budget);
    if (!way.ok()) {
      return Refused(StatusOf(way.status),
                     fmt::format("from waypoint {} to {}: {}, after {} cells of {:.3g} m; "
                                 "obstacles are inflated by {:.3g} m",
                                 i - 1, i, ToString(way.status), way.expansions, options.cell,
                                 inflation + OverACell(options)));
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

/// The first points of polylines that begin as the car stands, beside the start itself: straight on
/// for a while, then on or to either side, which a goal behind the car needs. Nearest first.
std::vector<std::vector<Vec2>> WaysOut(const PlanRequest& request) {
  const double radius = request.vehicle.min_turning_radius();
  const double braking =
      0.5 * request.start_speed * request.start_speed / request.speed.deceleration;
  const Vec2 ahead = Direction(request.start.yaw);
  const Vec2 from = request.start.position();
  std::vector<std::vector<Vec2>> ways;
  for (const double radii : {0.5, 1.0, 2.0}) {
    ways.push_back({from, from + (braking + radii * radius) * ahead});
  }
  for (const double radii : {1.5, 2.5}) {
    for (const double side : {1.0, -1.0}) {
      // A quarter turn; and half a turn, by two of them.
      const Vec2 corner = from + (braking + radii * radius) * ahead;
      const Vec2 beside = corner + 2.0 * side * radii * radius * LeftOf(ahead);
      ways.push_back({from, corner, beside});
      ways.push_back({from, corner, beside, beside - 2.0 * radii * radius * ahead});
    }
  }
  return ways;
}

bool IsFree(const std::vector<Vec2>& points, const std::vector<OrientedBox>& boxes,
            double inflation) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (std::any_of(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
          return Distance(points[i - 1], points[i], box) <= inflation;
        })) {
      return false;
    }
  }
  return true;
}

}  // namespace

Plan PlanWith(const AStarOptions& options, const PlanRequest& request) {
  if (Plan refused = CheckRoute(request); !refused.ok()) {
    return refused;
  }
  const double inflation = 0.5 * request.vehicle.width + options.safe_distance +
                           (options.corners == Corners::kRound ? options.corner_room : 0.0);
  std::vector<Vec2> stops = request.waypoints;
  stops.front() = request.start.position();
  const std::vector<std::vector<Vec2>> ways_out = WaysOut(request);
  for (const std::vector<Vec2>& way : ways_out) {
    stops.push_back(way.back());
  }
  const GridArea area = AreaAround(request.start, stops, request.obstacles, options.margin);
  if (CellsIn(area, options.cell) > kMostCells) {
    return Refused(PlanStatus::kBudgetUsedUp,
                   fmt::format("{:.3g} cells of {:.3g} m; at most {:.3g} are searched",
                               CellsIn(area, options.cell), options.cell, kMostCells));
  }
  const OccupancyGrid grid = RasterOf(request.start, area, options.cell, request.obstacles,
                                      inflation + OverACell(options));
  Plan direct = PlanGrid(options, request, grid, inflation, {request.start.position()});
  const std::vector<Excess> excesses =
      direct.ok() ? ExcessesOf(direct, request) : std::vector<Excess>{};
  // What slowing down mends is not a matter of how the path begins.
  const bool begins_right = std::all_of(excesses.begin(), excesses.end(),
                                        [](const Excess& excess) { return excess.by_speed; });
  if ((direct.ok() && begins_right) || options.corners == Corners::kRefuse) {
    return direct;
  }
  for (const std::vector<Vec2>& way : ways_out) {
    if (!IsFree(way, request.obstacles, inflation)) {
      continue;
    }
    Plan plan = PlanGrid(options, request, grid, inflation, way);
    if (plan.ok() && MakeFeasible(plan, request).ok()) {
      return plan;
    }
  }
  if (!direct.ok()) {
    return direct;
  }
  return Refused(PlanStatus::kTurnTooTight,
                 fmt::format("the path has {}, and none was found that begins at the car's heading "
                             "of {:.3g} rad{}",
                             ToString(*std::find_if(excesses.begin(), excesses.end(),
                                                    [](const Excess& e) { return !e.by_speed; })),
                             request.start.yaw,
                             request.start_speed > 0.0
                                 ? fmt::format(" and leaves room to slow down from {:.3g} m/s",
                                               request.start_speed)
                                 : ""));
}

Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  std::vector<Pose2> stops = StopsOf(request);
  Plan plan;
  plan.diagnostics["legs"] = nlohmann::json::array();
  const bool rolls = request.start_speed > 0.0;
  std::vector<Segment> segments;
  if (rolls) {
    const LeadIn lead =
        LeadInForCurves(request, RadiusFor(request.vehicle, options.radius), options.min_speed);
    const ClearWay clear(request.vehicle, request.obstacles, options.safe_distance);
    if (!IsFree(clear, stops[0], lead.segments)) {
      return Refused(PlanStatus::kStartBlocked,
                     fmt::format("an obstacle is too near to the first {:.3g} m, in which the "
                                 "rolling car slows down for its first bend",
                                 lead.length));
    }
    segments = lead.segments;
    stops[0] = lead.end;
  }
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const HybridAStarResult found = SearchHybridAStar(request.vehicle,
                                                      {.start = stops[i - 1],
                                                       .goal = stops[i],
                                                       .obstacles = request.obstacles,
                                                       .rolls = i == 1 && rolls},
                                                      options);
    if (!found.ok()) {
      return Refused(found.status,
                     fmt::format("from waypoint {} to {}: {}", i - 1, i, found.reason));
    }
    segments.insert(segments.end(), found.segments.begin(), found.segments.end());
    plan.diagnostics["legs"].push_back(
        {{"cost_m", found.cost}, {"expansions", found.expansions}, {"cells", found.cells}});
  }
  return AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

}  // namespace trackbed

#include "trackbed/planning/grid/astar_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/planning/sampling/prune_waypoints.h"
#include "src/planning/sampling/sampling_task.h"
#include "trackbed/geometry/box_index.h"
#include "trackbed/planning/common/corner_room.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/grid/astar.h"

// Plans leg by leg with A* on a grid (Hart, Nilsson and Raphael 1968), straightens each leg, and
// rounds its corners. The first path begins at the car's position. If the first path does not begin
// along the car's heading or is not feasible, other paths begin with straights and turns from the
// car. The search continues at the ends of these initial parts.

namespace trackbed {
namespace {

using route::CheckRoute;
using route::Refused;

PlanStatus ToPlanStatus(GridStatus status) {
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

/// Returns half the diagonal of a cell [m], by which obstacles are additionally inflated. With
/// obstacles inflated by this half diagonal, free cells and the lines between their centers keep
/// the required distance from obstacles.
double CellInflation(const AStarOptions& options) {
  return 0.5 * std::sqrt(2.0) * options.cell;
}

/// Returns the centers of the path's cells, followed by the exact goal.
std::vector<Vec2> WaypointsOnGrid(const OccupancyGrid& grid, const GridPath& way,
                                  const Vec2& goal) {
  std::vector<Vec2> points;
  for (const std::size_t cell : way.cells) {
    points.push_back(grid.CellCenter(cell));
  }
  if ((points.back() - goal).norm() > 1e-9 * grid.cell) {
    points.push_back(goal);
  } else {
    points.back() = goal;
  }
  return points;
}

/// Makes the leg to the waypoint `i` shorter, with corners that the car can drive where there is
/// room. The leg follows the polyline `points`.
std::vector<Vec2> Shorten(const std::vector<Vec2>& leg, const AStarOptions& options,
                          const PlanRequest& request, const Inflation& inflation, std::size_t i,
                          const std::vector<Vec2>& points) {
  const CornerTangents tangents(request.vehicle, std::min(options.min_speed, request.speed.speed));
  const WindScoring calm{};
  return JoinCloseCorners(
      Shortcut(leg, request.obstacles, inflation),
      {.before = points.size() > 1 ? std::optional(points[points.size() - 2]) : std::nullopt,
       .first_leg = points.size() <= 2,
       .last_leg = i + 1 == request.waypoints.size(),
       .obstacles = request.obstacles,
       .inflation = inflation,
       .wind = calm,
       .tangent = tangents});
}

/// Plans a path that begins with the polyline `points` and continues by A* from the last of these
/// points through all waypoints after the first.
Plan PlanGrid(const AStarOptions& options, const PlanRequest& request, const OccupancyGrid& grid,
              const Inflation& inflation, std::vector<Vec2> points) {
  const bool round = options.corners == Corners::kRound;
  Plan plan;
  AStarDiagnostics found;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    const Vec2 goal = request.waypoints[i];
    const int from = grid.CellAt(points.back());
    const int to = grid.CellAt(goal);
    const GridPath way = SearchGrid(grid, static_cast<std::size_t>(from),
                                    static_cast<std::size_t>(to), options.budget);
    if (way.status == GridStatus::kGoalOccupied) {
      return route::GoalBlocked(request, i, options.safe_distance);
    }
    if (!way.ok()) {
      return Refused(ToPlanStatus(way.status),
                     fmt::format("from waypoint {} to {}: {}, after {} cells of {:.3g} m; "
                                 "obstacles are inflated by {:.3g} m",
                                 i - 1, i, ToString(way.status), way.expansions, options.cell,
                                 inflation.most + CellInflation(options)));
    }
    std::vector<Vec2> leg = WaypointsOnGrid(grid, way, goal);
    leg.front() = points.back();
    found.legs.push_back({.cost = way.cost * options.cell,
                          .expansions = way.expansions,
                          .cells = grid.size(),
                          .path = WithoutCollinearPoints(leg)});
    if (round) {
      leg = Shorten(leg, options, request, inflation, i, points);
    }
    points.insert(points.end(), leg.begin() + 1, leg.end());
  }
  if (!round) {
    points = WithoutCollinearPoints(points);
  }
  plan.diagnostics.planner = std::move(found);
  return route::AlongPolyline(std::move(plan), request, points, options.corners,
                              options.safe_distance, options.min_speed);
}

bool IsFree(const std::vector<Vec2>& points, const BoxIndex& boxes, const Inflation& inflation) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!boxes.KeepsFrom(points[i - 1], points[i], inflation)) {
      return false;
    }
  }
  return true;
}

/// Plans on a grid around inflated obstacles. The cells of the waypoints and the cell at which the
/// search begins are free even if the inflation covers them.
class GridPlanner {
 public:
  GridPlanner(const AStarOptions& options, const PlanRequest& request, const GridArea& area,
              double inflation)
      : options_(options),
        request_(request),
        area_(area),
        inflation_(inflation),
        goals_(route::GoalsOutsideObstacles(
            request, route::CheckerFromStart(request, options.safe_distance))),
        grid_(MakeGrid(inflation + CellInflation(options))) {}

  /// Plans a path that begins with the polyline `points`. All points after the first one are
  /// farther from obstacles than the inflation, or as far as the search allows.
  [[nodiscard]] Plan From(const std::vector<Vec2>& points) const {
    std::vector<Vec2> ends = goals_;
    ends.push_back(points.back());
    std::vector<Vec2> cells;
    for (const Vec2& end : ends) {
      cells.push_back(grid_.CellCenter(static_cast<std::size_t>(grid_.CellAt(end))));
    }
    const Inflation lines = InflationAt(ends, request_.obstacles, inflation_);
    const Inflation on_grid = InflationAt(cells, request_.obstacles, grid_inflation());
    return PlanGrid(options_, request_, on_grid.own.empty() ? grid_ : MakeGrid(on_grid), lines,
                    points);
  }

 private:
  [[nodiscard]] double grid_inflation() const { return inflation_ + CellInflation(options_); }

  [[nodiscard]] OccupancyGrid MakeGrid(const Inflation& inflation) const {
    return Rasterize(request_.start, area_, options_.cell, request_.obstacles, inflation);
  }

  const AStarOptions& options_;
  const PlanRequest& request_;
  GridArea area_;
  double inflation_;
  std::vector<Vec2> goals_;
  OccupancyGrid grid_;
};

Plan PlanOnGrid(const AStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckRoute(request), route::CheckStart(request, options.safe_distance)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  const double inflation = 0.5 * request.vehicle.width + options.safe_distance +
                           (options.corners == Corners::kRound ? options.corner_room : 0.0);
  std::vector<Vec2> stops = request.waypoints;
  stops.front() = request.start.position();
  const std::vector<std::vector<Vec2>> departures = DeparturePolylines(request);
  for (const std::vector<Vec2>& way : departures) {
    stops.push_back(way.back());
  }
  const GridArea area = AreaAround(request.start, stops, request.obstacles, options.margin);
  if (CellsIn(area, options.cell) > kMaxCells) {
    return Refused(PlanStatus::kBudgetUsedUp,
                   fmt::format("{:.3g} cells of {:.3g} m; must be at most {:.3g}",
                               CellsIn(area, options.cell), options.cell, kMaxCells));
  }
  const GridPlanner planner(options, request, area, inflation);
  Plan direct = planner.From({request.start.position()});
  const std::string wrong_start = direct.ok() ? route::WrongStart(direct, request) : "";
  const bool begins_right = wrong_start.empty();
  if (options.corners == Corners::kRefuse ||
      (direct.ok() && begins_right && MakeFeasible(direct, request).ok())) {
    return direct;
  }
  const BoxIndex obstacles(request.obstacles);
  const Inflation leaving = InflationAt({request.start.position()}, request.obstacles, inflation);
  for (const std::vector<Vec2>& way : departures) {
    if (!IsFree(way, obstacles, leaving)) {
      continue;
    }
    Plan plan = planner.From(way);
    if (plan.ok() && MakeFeasible(plan, request).ok()) {
      return plan;
    }
  }
  if (!direct.ok() || begins_right) {
    return direct;
  }
  return Refused(
      PlanStatus::kTurnTooTight,
      fmt::format(
          "the path is not feasible: {}; no path was found that starts at the car's heading of "
          "{:.3g} rad{}",
          wrong_start, request.start.yaw,
          request.start_speed > 0.0
              ? fmt::format(" and leaves room to slow down from {:.3g} m/s", request.start_speed)
              : ""));
}

Plan PlanWith(const AStarOptions& options, const PlanRequest& request) {
  const double room = options.corners == Corners::kRound ? options.corner_room : 0.0;
  return WithLessCornerRoom(request, room, [&](const PlanRequest& own, double corner_room) {
    AStarOptions with = options;
    with.corner_room = corner_room;
    return PlanOnGrid(with, own);
  });
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const AStarLeg& leg) {
  out.Number("cost_m", leg.cost);
  out.Integer("expansions", leg.expansions);
  out.Integer("cells", leg.cells);
  if (out.full()) {
    out.Points("path_m", leg.path);
  }
}

void Visit(DiagnosticsVisitor& out, const AStarDiagnostics& own) {
  out.List("legs", own.legs);
}

void Visit(KeyVisitor& keys, AStarOptions& options) {
  route::VisitCorners(keys, options.corners, options.safe_distance, options.corner_room);
  keys.Field(route::kGridCell, options.cell, Need::kOptional, route::kCellSize);
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field(route::kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
  keys.Field({"budget", "", "maximum expanded cells per leg"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e9});
}

PlannerEntry AStarPlanner() {
  return {.name = "astar",
          .summary = "A* on a grid around obstacles, corners rounded or refused (Hart et al. 1968)",
          .defaults = AStarOptions{},
          .plan = PlanBy<AStarOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .bounds_waypoint_miss = true,
          .searches = true,
          .has_ties = true};
}

}  // namespace trackbed

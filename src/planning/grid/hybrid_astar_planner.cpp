#include <fmt/format.h>

#include "trackbed/planning/common/route.h"
#include "trackbed/planning/grid/hybrid_astar.h"

namespace trackbed {
namespace {

using route::CheckRadius;
using route::CheckRoute;
using route::IsFree;
using route::LeadInForCurves;
using route::RadiusFor;
using route::Refused;

Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  std::vector<Pose2> stops = PlannedStops(request);
  Plan plan;
  HybridAStarDiagnostics diagnostics;
  const bool rolls = request.start_speed > 0.0;
  std::vector<Segment> segments;
  if (rolls) {
    const LeadIn lead =
        LeadInForCurves(request, RadiusFor(request.vehicle, options.radius), options.min_speed);
    const CollisionChecker clear(request.vehicle, request.obstacles, options.safe_distance);
    if (!IsFree(clear, stops[0], lead.segments)) {
      return Refused(PlanStatus::kStartBlocked,
                     fmt::format("an obstacle is too close to the first {:.3g} m, in which the car "
                                 "slows down for its first turn",
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
    diagnostics.legs.push_back(
        {.cost = found.cost, .expansions = found.expansions, .cells = found.cells});
  }
  plan.diagnostics.planner = std::move(diagnostics);
  return route::AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

bool MayReverse(const PlannerOptions& options) {
  return options.Get<HybridAStarOptions>().reverse;
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg) {
  out.Number("cost_m", leg.cost);
  out.Integer("expansions", leg.expansions);
  out.Integer("cells", leg.cells);
}

void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own) {
  out.List("legs", own.legs);
}

void Visit(KeyVisitor& keys, HybridAStarOptions& options) {
  route::VisitCurves(keys, options.radius, options.safe_distance, options.min_speed);
  keys.Field({"reverse", "", "whether the path may reverse"}, options.reverse, Need::kOptional);
  keys.Field({"reverse_cost", "", "cost factor of reverse travel"}, options.reverse_cost,
             Need::kOptional, Range{.min = 1.0, .max = 1e3});
  keys.Field({"switch_cost", "m", "cost of a change of direction"}, options.switch_cost,
             Need::kOptional, kNonNegative);
  keys.Field({"steering_cost", "m", "cost of a curvature step from straight to the radius"},
             options.steering_cost, Need::kOptional, kNonNegative);
  keys.Field({"weight", "",
              "weight of the heuristic: above 1, fewer expansions, and a cost of at most `weight` "
              "times the optimum"},
             options.weight, Need::kOptional, Range{.min = 1.0, .max = 10.0});
  keys.Field(route::kGridCell, options.cell, Need::kOptional, route::kCellSize);
  keys.Field({"headings", "", "number of heading cells"}, options.headings, Need::kOptional,
             Range{.min = 8, .max = 720});
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"budget", "", "maximum expanded poses per leg"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e7});
}

PlannerEntry HybridAStarPlanner() {
  return {
      .name = "hybrid_astar",
      .summary =
          "hybrid A* around obstacles through kinematically feasible poses, forward and reverse",
      .defaults = HybridAStarOptions{},
      .plan = PlanBy<HybridAStarOptions, PlanWith>,
      .min_waypoints = 2,
      .keeps_clear = true,
      .has_headings = true,
      .goes_backwards = true,
      .searches = true,
      .may_go_backwards = MayReverse,
      .detour_defaults = HybridAStarOptions{.radius = {}, .reverse = false}};
}

}  // namespace trackbed

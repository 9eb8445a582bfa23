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
  std::vector<Pose2> stops = StopsOf(request);
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
  keys.Field({"reverse", "", "whether it may go backwards"}, options.reverse, Need::kOptional);
  keys.Field({"reverse_cost", "", "of a meter backwards, in meters"}, options.reverse_cost,
             Need::kOptional, Range{.min = 1.0, .max = 1e3});
  keys.Field({"switch_cost", "m", "of a change of direction"}, options.switch_cost, Need::kOptional,
             kNonNegative);
  keys.Field({"steering_cost", "m", "of a step of curvature from straight on to the radius"},
             options.steering_cost, Need::kOptional, kNonNegative);
  keys.Field(
      {"weight", "",
       "of the estimate of what is left: above 1 it looks at less, and its way may cost so many "
       "times as much"},
      options.weight, Need::kOptional, Range{.min = 1.0, .max = 10.0});
  keys.Field(route::kGridCell, options.cell, Need::kOptional, route::kCellSize);
  keys.Field({"headings", "", "cells of a full turn"}, options.headings, Need::kOptional,
             Range{.min = 8, .max = 720});
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"budget", "", "poses to look at for each leg, at most"}, options.budget,
             Need::kOptional, Range{.min = 0, .max = 1e7});
}

PlannerEntry HybridAStarPlanner() {
  return {.name = "hybrid_astar",
          .summary = "around obstacles through poses that the car can drive, either way",
          .defaults = HybridAStarOptions{},
          .plan = PlanBy<HybridAStarOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .has_headings = true,
          .goes_backwards = true,
          .searches = true,
          .may_go_backwards = MayReverse};
}

}  // namespace trackbed

#include <cmath>
#include <limits>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/replan/replan.h"

/// The keys of `plan.replan`: what plans again while driving.
namespace trackbed {
namespace {

/// How far the road reaches; a side that is not given has no end.
void VisitRoadSide(KeyVisitor& keys, const Key& key, double& width) {
  std::optional<double> side;
  if (std::isfinite(width)) {
    side = width;
  }
  keys.Field(key, side, kPositive);
  width = side.value_or(std::numeric_limits<double>::infinity());
}

/// Planners that find a path around obstacles by themselves, set to go forwards.
std::vector<PlannerEntry> DetourPlanners() {
  std::vector<PlannerEntry> fit;
  for (PlannerEntry entry : Planners()) {
    if (auto* hybrid = entry.defaults.As<HybridAStarOptions>()) {
      hybrid->reverse = false;
    }
    if (entry.keeps_clear && !MayGoBackwards(entry.defaults)) {
      fit.push_back(entry);
    }
  }
  return fit;
}

}  // namespace

void Visit(KeyVisitor& keys, RoadWidths& road) {
  VisitRoadSide(keys, {"left", "m", "of the route; without it there is no end"}, road.left);
  VisitRoadSide(keys, {"right", "m", "of the route; without it there is no end"}, road.right);
}

void Visit(KeyVisitor& keys, DetourChoice& choice) {
  keys.Field({"attempts", "", "of a random planner, each with a seed of its own"}, choice.attempts,
             Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"collision_penalty", "m", "for a way that is blocked"},
             choice.comparator.collision_penalty, Need::kOptional, kNonNegative);
  keys.Field({"wind_weight", "", "of the wind along the way, in meters for meters"},
             choice.wind_weight, Need::kOptional, kNonNegative);
}

void Visit(KeyVisitor& keys, ReplanOptions& options) {
  keys.Field({"period", "s", "between two looks at what is known"}, options.period, Need::kOptional,
             Range{.min = 0.05, .max = 60.0});
  keys.Field({"look_ahead", "s", "for which the way must be clear, or another is looked for"},
             options.settings.look_ahead, Need::kOptional, Range{.min = 1.0, .max = 60.0});
  keys.Field(route::kOutlineDistance, options.settings.safe_distance, Need::kOptional,
             kNonNegative);
  keys.Section({"road", "", "how far it reaches beside the route, for the outline"},
               options.settings.road);
  keys.Field({"gap", "m", "from bumper to bumper, behind what is in the way"}, options.settings.gap,
             Need::kOptional, kNonNegative);
  keys.Field({"time_gap", "s", "besides, behind what moves"}, options.settings.time_gap,
             Need::kOptional, kNonNegative);
  keys.Method({"along", "", "how motions along the route are found"}, options.along, AlongMethods(),
              Need::kOptional);
  keys.Method({"detour", "", "another way to the goal, when no motion along the route leads past"},
              options.detour, DetourPlanners(), Need::kOptional);
  keys.Section({"comparator", "", "what decides for a detour, or against it"}, options.comparator);
  if (options.detour && !options.comparator) {
    options.comparator.emplace();
  }
}

}  // namespace trackbed

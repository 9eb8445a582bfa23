#include "trackbed/planning/replan/replan_options.h"

#include <cmath>
#include <limits>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/replan/along_route.h"

/// Option keys of `plan.replan`, which configure replanning while the car drives.
namespace trackbed {
namespace {

/// Visits the option key for the road's width on one side of the path, which is unlimited by
/// default.
void VisitRoadSide(KeyVisitor& keys, const Key& key, double& width) {
  std::optional<double> side;
  if (std::isfinite(width)) {
    side = width;
  }
  keys.Field(key, side, kPositive);
  width = side.value_or(std::numeric_limits<double>::infinity());
}

/// Returns the planners that can plan detours: they avoid obstacles and drive only forwards.
std::vector<PlannerEntry> DetourPlanners() {
  std::vector<PlannerEntry> fit;
  for (PlannerEntry entry : Planners()) {
    if (entry.detour_defaults) {
      entry.defaults = *entry.detour_defaults;
    }
    if (entry.keeps_clear && !MayGoBackwards(entry.defaults)) {
      fit.push_back(entry);
    }
  }
  return fit;
}

}  // namespace

void Visit(KeyVisitor& keys, RoadWidths& road) {
  VisitRoadSide(keys, {"left", "m", "distance from the route; default: unlimited"}, road.left);
  VisitRoadSide(keys, {"right", "m", "distance from the route; default: unlimited"}, road.right);
}

void Visit(KeyVisitor& keys, DetourChoice& choice) {
  keys.Field({"attempts", "", "attempts of a randomized planner, each with its own seed"},
             choice.attempts, Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"collision_penalty", "m", "penalty for a blocked path"},
             choice.comparator.collision_penalty, Need::kOptional, kNonNegative);
  keys.Field({"wind_weight", "", "weight of the wind along the path"}, choice.wind_weight,
             Need::kOptional, kNonNegative);
}

void Visit(KeyVisitor& keys, ReplanOptions& options) {
  keys.Field({"period", "s", "replanning period"}, options.period, Need::kOptional,
             Range{.min = 0.05, .max = 60.0});
  keys.Field({"look_ahead", "s",
              "time horizon for which the path must be clear, else a replan is triggered"},
             options.settings.look_ahead, Need::kOptional, Range{.min = 1.0, .max = 60.0});
  keys.Field(route::kFootprintDistance, options.settings.safe_distance, Need::kOptional,
             kNonNegative);
  keys.Section({"road", "", "drivable width left and right of the route, for the car's footprint"},
               options.settings.road);
  keys.Field({"gap", "m", "bumper-to-bumper gap behind an obstacle"}, options.settings.gap,
             Need::kOptional, kNonNegative);
  keys.Field({"time_gap", "s", "additional time gap behind moving obstacles"},
             options.settings.time_gap, Need::kOptional, kNonNegative);
  keys.Method({"along", "", "planner of motions along the route"}, options.along, AlongMethods(),
              Need::kOptional);
  keys.Method({"detour", "", "planner of a detour, when no motion along the route is feasible"},
              options.detour, DetourPlanners(), Need::kOptional);
  keys.Section({"comparator", "", "criterion for taking a detour"}, options.comparator);
  if (options.detour && !options.comparator) {
    options.comparator.emplace();
  }
}

}  // namespace trackbed

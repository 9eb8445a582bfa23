#include "trackbed/planning/common/route.h"
#include "trackbed/planning/sampling/rrt_planner.h"

namespace trackbed {

void Visit(KeyVisitor& keys, RrtPlannerOptions& options) {
  route::VisitCorners(keys, options.corners, options.safe_distance, options.corner_room);
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"lead_in", "m", "straight distance from the start before the trees; 0: none"},
             options.lead_in, Need::kOptional, kNonNegative);
  keys.Field(route::kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
  keys.Field({"trees", "", "number of trees; the best feasible path of all is the plan"},
             options.trees, Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"iterations", "", "maximum samples per leg and tree"}, options.iterations,
             Need::kOptional, Range{.min = 0, .max = 1e6});
  keys.Field({"time_limit", "s",
              "wall-clock time limit of the tree growth; makes the plan depend on the machine's "
              "speed, unlike `iterations`; default: none"},
             options.time_limit, kPositive);
  keys.Field({"partial", "",
              "whether to use the path to the node nearest to the goal if no tree reaches it; "
              "default: true with a time_limit"},
             options.partial);
  keys.Field({"expand_distance", "m", "maximum distance from a node toward a sample"},
             options.expand_distance, Need::kOptional, kPositive);
  keys.Field({"goal_bias", "", "fraction of samples at the goal"}, options.goal_bias,
             Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field({"data_weight", "", "alpha of the smoothing: attraction to the original points"},
             options.data_weight, Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field({"smoothness_weight", "",
              "beta of the smoothing: attraction to the neighbors' midpoint; data_weight + 2 "
              "smoothness_weight must be above 0 and below 1"},
             options.smoothness_weight, Need::kOptional, Range{.min = 0.0, .max = 0.5});
  keys.Field({"corner_cost", "m",
              "cost of a corner, as path length: favors fewer corners and longer legs"},
             options.corner_cost, Need::kOptional, kNonNegative);
  keys.Field({"wind_weight", "", "weight of the wind in the path length; 0: ignored"},
             options.wind_weight, Need::kOptional, kNonNegative);
}

}  // namespace trackbed

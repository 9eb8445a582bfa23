#include "trackbed/planning/common/route.h"
#include "trackbed/planning/sampling/rrt_planner.h"

namespace trackbed {

void Visit(KeyVisitor& keys, RrtPlannerOptions& options) {
  route::VisitCorners(keys, options.corners, options.safe_distance, options.corner_room);
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"lead_in", "m", "straight on from the start, before the trees begin; 0: none"},
             options.lead_in, Need::kOptional, kNonNegative);
  keys.Field(route::kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
  keys.Field({"trees", "", "grown; of their ways the best one that the car can drive is the plan"},
             options.trees, Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"iterations", "", "samples for each leg of each tree, at most"}, options.iterations,
             Need::kOptional, Range{.min = 0, .max = 1e6});
  keys.Field(
      {"time_limit", "s",
       "by the clock on the wall, after which no tree grows any more: such a plan may differ "
       "from run to run, one by `iterations` alone does not; else no limit"},
      options.time_limit, kPositive);
  keys.Field(
      {"partial", "",
       "whether, when no tree reaches the goal, the path to the node nearest to it is driven; "
       "else it is if there is a time_limit"},
      options.partial);
  keys.Field({"expand_distance", "m", "from a node toward a sample at most"},
             options.expand_distance, Need::kOptional, kPositive);
  keys.Field({"goal_bias", "", "share of samples at the goal"}, options.goal_bias, Need::kOptional,
             Range{.min = 0.0, .max = 1.0});
  keys.Field({"data_weight", "", "alpha of the smoothing: keeps points where they are"},
             options.data_weight, Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field({"smoothness_weight", "",
              "beta of the smoothing: draws points between their neighbors; data_weight + 2 "
              "smoothness_weight is above 0 and below 1"},
             options.smoothness_weight, Need::kOptional, Range{.min = 0.0, .max = 0.5});
  keys.Field({"corner_cost", "m", "of a corner, as so much way: fewer corners, with longer legs"},
             options.corner_cost, Need::kOptional, kNonNegative);
  keys.Field({"wind_weight", "", "how much wind counts in the length of a way; 0: not at all"},
             options.wind_weight, Need::kOptional, kNonNegative);
}

}  // namespace trackbed

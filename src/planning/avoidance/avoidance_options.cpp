#include "trackbed/planning/avoidance/avoidance_options.h"

/// Option keys of `plan.avoid`, which select and configure a local planner.
namespace trackbed {
namespace {

/// Option keys that all methods of `plan.avoid` share.
template <typename Options>
void VisitAvoider(KeyVisitor& keys, Options& options) {
  keys.Field({"safe_distance", "m", "minimum distance of the car's footprint from obstacles"},
             options.safe_distance, Need::kOptional, kNonNegative);
  keys.Field({"delay", "s", "time from detecting an obstacle to the new plan"}, options.delay,
             Need::kOptional, kNonNegative);
}

}  // namespace

void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options) {
  VisitAvoider(keys, options);
  static const EnumNames<PassingSideChoice> sides{{PassingSideChoice::kAuto, "auto"},
                                                  {PassingSideChoice::kInner, "inner"},
                                                  {PassingSideChoice::kOuter, "outer"}};
  keys.Field({"passing_side", "",
              "passing side: toward the turn's center (left on a straight), away from it, or the "
              "shorter one found by RRT*"},
             options.passing_side, Need::kOptional, sides);
  keys.Field({"min_speed", "m/s", "minimum speed past an obstacle"}, options.min_speed,
             Need::kOptional, kPositive);
  keys.Field({"max_lateral_acceleration", "m/s^2", "maximum lateral acceleration of the curve"},
             options.max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"max_steering_rate_fraction", "",
              "maximum fraction of the car's steering rate that the curve may use"},
             options.max_steering_rate_fraction, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"comfortable_steering_rate_fraction", "",
              "fraction of the steering rate up to which curves are preferred"},
             options.comfortable_steering_rate_fraction, Need::kOptional,
             Range{.max = 1.0, .above = 0.0});
  // A detour grows one tree for each side of the obstacle, with up to kMaxDetourSamples samples in
  // both trees together.
  keys.Field({"rrt_iterations", "", "number of RRT* samples"}, options.rrt_iterations,
             Need::kOptional, Range{.min = 0, .max = 1e5});
  keys.Field({"rrt_step", "m", "maximum distance from a node toward a sample"}, options.rrt_step,
             Need::kOptional, kPositive);
  keys.Section({"search", "", "optimizer of the curve's control points"}, options.search);
}

void Visit(KeyVisitor& keys, ListingAvoidanceOptions& options) {
  VisitAvoider(keys, options);
  keys.Field({"inner_width", "m",
              "free width toward the turn's center; the curve passes on the wider side, on this "
              "one if equal"},
             options.inner_width, Need::kOptional, kNonNegative);
  keys.Field({"outer_width", "m", "free width on the other side"}, options.outer_width,
             Need::kOptional, kNonNegative);
  keys.Field({"grid", "", "arc in steps of 0.01 rad, as printed; else exact"}, options.literal.grid,
             Need::kOptional);
  keys.Field({"right_shift", "",
              "P_5 of a right turn shifted, as printed; else right turns mirror left turns"},
             options.literal.right_shift, Need::kOptional);
  keys.Field({"right_angle_rule", "",
              "special rules for P_5 to P_7 of 90 degree turns, as printed; else the general rule"},
             options.literal.right_angle_rule, Need::kOptional);
}

}  // namespace trackbed

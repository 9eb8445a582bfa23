#pragma once

#include "src/scenario/visit_control.h"
#include "trackbed/scenario/scenario.h"

/// The keys of planners and avoiders.
namespace trackbed {

inline EnumNames<SearchMethod> SearchNames() {
  EnumNames<SearchMethod> names;
  for (const SearchEntry& entry : Searches()) {
    names.emplace_back(entry.method, entry.name);
  }
  return names;
}

template <typename Archive>
void Visit(Archive& a, SearchOptions& options) {
  static const EnumNames<SearchMethod> methods = SearchNames();
  a.Field({"method", "", "the search; see 'trackbed list optimizers'"}, options.method,
          Need::kOptional, methods);
  a.Field({"population", "", "of isres, esch and crs2"}, options.population, Need::kOptional,
          Range{.min = 3, .max = 1e5});
  a.Field({"evaluations", "", "at most; 0: the method's own number"}, options.evaluations,
          Need::kOptional, Range{.min = 0, .max = 1e8});
  a.Field({"tolerance", "", "on the variables, as a share of their bounds; 0: none"},
          options.tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

template <typename Archive>
void Visit(Archive& a, DrivenWeights& weights) {
  a.Field({"position", "1/m^3", "of the squared distance from the path, over its length"},
          weights.position, Need::kOptional, kNotNegative);
  a.Field({"heading", "1/m", "of the squared heading error, over its length"}, weights.heading,
          Need::kOptional, kNotNegative);
  a.Field({"end", "1/m^2", "of the squared distance from the goal at the end"}, weights.end,
          Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, FilletOptions& options) {
  a.Field({"radius", "m", "of every turn; else the largest that the constraint allows"},
          options.radius, kPositive);
  static const EnumNames<RadiusConstraint> constraints{
      {RadiusConstraint::kSteeringRoom, "steering_room"},
      {RadiusConstraint::kHalfLeg, "half_leg"},
      {RadiusConstraint::kNone, "none"}};
  a.Field({"constraint", "",
           "what a radius must leave: room to turn the wheels (C.40), half the shorter leg (C.34), "
           "or nothing"},
          options.constraint, Need::kOptional, constraints);
  a.Field({"neutral_steering", "rad",
           "where the wheels stand between turns, start from and return to, positive to the left; "
           "unless it is 0 a kinematic car leaves its straight legs"},
          options.neutral_steering, Need::kOptional, kSteering);
  a.Field({"max_radius", "m", "upper bound of the search"}, options.max_radius, Need::kOptional,
          kPositive);
  static const EnumNames<WithoutRoom> without_room{{WithoutRoom::kSlowDown, "slow_down"},
                                                   {WithoutRoom::kHalfLeg, "half_leg"},
                                                   {WithoutRoom::kRefuse, "refuse"}};
  a.Field({"without_room", "", "what becomes of a turn for which C.40 has no radius"},
          options.without_room, Need::kOptional, without_room);
  a.Field({"min_speed", "m/s", "no turn is slowed down below this"}, options.min_speed,
          Need::kOptional, kPositive);
  static const EnumNames<RadiusObjective> objectives{{RadiusObjective::kLargest, "largest"},
                                                     {RadiusObjective::kLiteral, "literal"},
                                                     {RadiusObjective::kTurnLocal, "turn_local"},
                                                     {RadiusObjective::kDriven, "driven"}};
  a.Field({"objective", "",
           "by what radii are chosen: the largest, the dissertation's window over the route, over "
           "the turn, or the driven car's error"},
          options.objective, Need::kOptional, objectives);
  a.Section({"search", "", "how it is minimised; not for 'largest'"}, options.search);
  a.Field({"resimulate_each_turn", "", "a first drive before every turn, not one for all"},
          options.resimulate_each_turn, Need::kOptional);
  static const EnumNames<ReferencePoint> references{
      {ReferencePoint::kRearAxle, "rear_axle"},
      {ReferencePoint::kCentreOfGravity, "centre_of_gravity"}};
  a.Field({"reference", "", "the point of the car that first drives follow"}, options.reference,
          Need::kOptional, references);
  a.Section({"weights", "", "of the objective 'driven'"}, options.weights);
}

template <typename Archive>
void Visit(Archive& a, LaneChangePlannerOptions& options) {
  static const EnumNames<LaneChangeStandard> standards{
      {LaneChangeStandard::kIso3888_1, "iso_3888_1"},
      {LaneChangeStandard::kIso3888_2, "iso_3888_2"}};
  a.Field({"standard", "", "whose gates"}, options.standard, Need::kOptional, standards);
  static const EnumNames<Side> sides{{Side::kLeft, "left"}, {Side::kRight, "right"}};
  a.Field({"first", "", "to which side the first change is"}, options.first, Need::kOptional,
          sides);
  a.Field({"lead_in", "m", "from the start to the first gate"}, options.lead_in, Need::kOptional,
          kPositive);
  a.Field({"lead_out", "m", "straight on after the last gate, before stopping"}, options.lead_out,
          Need::kOptional, kPositive);
  a.Field({"leave", "m", "the rear axle leaves a gate's middle so far before its end"},
          options.leave, Need::kOptional, Range{.min = -5.0, .max = 5.0});
  a.Field({"join", "m", "and is on the next one's so far after its beginning"}, options.join,
          Need::kOptional, Range{.min = -5.0, .max = 5.0});
}

template <typename Archive>
void Visit(Archive& a, CoursePiece& piece) {
  static constexpr Range kCurvature{.min = -10.0, .max = 10.0};  // [1/m]
  a.Field({"length", "m", "along the course"}, piece.length, Need::kRequired,
          Range{.max = 1e6, .above = 0.0});
  a.Field({"curvature", "1/m", "of a straight (0) or an arc, positive to the left"},
          piece.curvature, kCurvature);
  a.Field({"curvature_from", "1/m", "where a ramp begins; else where the piece before it ends"},
          piece.curvature_from, kCurvature);
  a.Field({"curvature_to", "1/m", "where a ramp ends"}, piece.curvature_to, kCurvature);
}

template <typename Archive>
void Visit(Archive& a, CourseOptions& options) {
  a.List({"segments", "", "of the course from the car's start on, at least one"}, options.segments);
}

inline constexpr Key kCurveRadius{"radius", "m",
                                  "of the arcs; else a tenth more than the car's smallest"};
inline constexpr Key kOutlineDistance{"safe_distance", "m", "of the car's outline from obstacles"};
inline constexpr Key kStepSpeed{"min_speed", "m/s", "no step of curvature is taken more slowly"};

template <typename Archive>
void VisitCurves(Archive& a, std::optional<double>& radius, double& safe_distance,
                 double& min_speed) {
  a.Field(kCurveRadius, radius, kPositive);
  a.Field(kOutlineDistance, safe_distance, Need::kOptional, kNotNegative);
  a.Field(kStepSpeed, min_speed, Need::kOptional, kPositive);
}

template <typename Archive>
void Visit(Archive& a, DubinsOptions& options) {
  VisitCurves(a, options.radius, options.safe_distance, options.min_speed);
}

template <typename Archive>
void Visit(Archive& a, ReedsSheppOptions& options) {
  VisitCurves(a, options.radius, options.safe_distance, options.min_speed);
}

inline constexpr Key kGridCell{"cell", "m", "side of a cell"};
inline constexpr Key kGridMargin{"margin", "m",
                                 "around waypoints and obstacles, within which to look"};
inline constexpr Range kCellSize{.min = 0.05, .max = 10.0};

inline constexpr Key kCornerSpeed{"min_speed", "m/s", "no corner is taken more slowly"};

template <typename Archive>
void VisitCorners(Archive& a, Corners& corners, double& safe_distance, double& corner_room) {
  static const EnumNames<Corners> names{{Corners::kRound, "round"}, {Corners::kRefuse, "refuse"}};
  a.Field({"corners", "",
           "what becomes of corners: rounded by clothoids and arcs that the wheels can follow, or "
           "no plan"},
          corners, Need::kOptional, names);
  a.Field(kOutlineDistance, safe_distance, Need::kOptional, kNotNegative);
  a.Field({"corner_room", "m", "that the search keeps besides, for rounded corners"}, corner_room,
          Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, AStarOptions& options) {
  VisitCorners(a, options.corners, options.safe_distance, options.corner_room);
  a.Field(kGridCell, options.cell, Need::kOptional, kCellSize);
  a.Field(kGridMargin, options.margin, Need::kOptional, kNotNegative);
  a.Field(kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
  a.Field({"budget", "", "cells to look at for each leg, at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e9});
}

template <typename Archive>
void Visit(Archive& a, HybridAStarOptions& options) {
  VisitCurves(a, options.radius, options.safe_distance, options.min_speed);
  a.Field({"reverse", "", "whether it may go backwards"}, options.reverse, Need::kOptional);
  a.Field({"reverse_cost", "", "of a metre backwards, in metres"}, options.reverse_cost,
          Need::kOptional, Range{.min = 1.0, .max = 1e3});
  a.Field({"switch_cost", "m", "of a change of direction"}, options.switch_cost, Need::kOptional,
          kNotNegative);
  a.Field({"steering_cost", "m", "of a step of curvature from straight on to the radius"},
          options.steering_cost, Need::kOptional, kNotNegative);
  a.Field(
      {"weight", "",
       "of the estimate of what is left: above 1 it looks at less, and its way may cost so many "
       "times as much"},
      options.weight, Need::kOptional, Range{.min = 1.0, .max = 10.0});
  a.Field(kGridCell, options.cell, Need::kOptional, kCellSize);
  a.Field({"headings", "", "cells of a full turn"}, options.headings, Need::kOptional,
          Range{.min = 8, .max = 720});
  a.Field(kGridMargin, options.margin, Need::kOptional, kNotNegative);
  a.Field({"budget", "", "poses to look at for each leg, at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e7});
}

template <typename Archive>
void Visit(Archive& a, RrtPlannerOptions& options) {
  VisitCorners(a, options.corners, options.safe_distance, options.corner_room);
  a.Field(kGridMargin, options.margin, Need::kOptional, kNotNegative);
  a.Field({"lead_in", "m", "straight on from the start, before the trees begin; 0: none"},
          options.lead_in, Need::kOptional, kNotNegative);
  a.Field(kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
  a.Field({"trees", "", "grown; of their ways the best one that the car can drive is the plan"},
          options.trees, Need::kOptional, Range{.min = 1, .max = 1000});
  a.Field({"iterations", "", "samples for each leg of each tree, at most"}, options.iterations,
          Need::kOptional, Range{.min = 0, .max = 1e6});
  a.Field({"time_limit", "s",
           "by the clock on the wall, after which no tree grows any more: such a plan may differ "
           "from run to run, one by `iterations` alone does not; else no limit"},
          options.time_limit, kPositive);
  a.Field({"partial", "",
           "whether, when no tree reaches the goal, the path to the node nearest to it is driven; "
           "else it is if there is a time_limit"},
          options.partial);
  a.Field({"expand_distance", "m", "from a node toward a sample at most"}, options.expand_distance,
          Need::kOptional, kPositive);
  a.Field({"goal_bias", "", "share of samples at the goal"}, options.goal_bias, Need::kOptional,
          Range{.min = 0.0, .max = 1.0});
  a.Field({"data_weight", "", "alpha of the smoothing: keeps points where they are"},
          options.data_weight, Need::kOptional, Range{.min = 0.0, .max = 1.0});
  a.Field({"smoothness_weight", "",
           "beta of the smoothing: draws points between their neighbours; data_weight + 2 "
           "smoothness_weight is above 0 and below 1"},
          options.smoothness_weight, Need::kOptional, Range{.min = 0.0, .max = 0.5});
  a.Field({"corner_cost", "m", "of a corner, as so much way: fewer corners, with longer legs"},
          options.corner_cost, Need::kOptional, kNotNegative);
  a.Field({"wind_weight", "", "how much wind counts in the length of a way; 0: not at all"},
          options.wind_weight, Need::kOptional, kNotNegative);
}

/// What every method of `plan.avoid` has.
template <typename Archive, typename Options>
void VisitAvoider(Archive& a, Options& options) {
  a.Field({"safe_distance", "m", "of the car's outline from obstacles"}, options.safe_distance,
          Need::kOptional, kNotNegative);
  a.Field({"delay", "s", "from learning of an obstacle to the new plan"}, options.delay,
          Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, BezierAvoidanceOptions& options) {
  VisitAvoider(a, options);
  static const EnumNames<RingChoice> rings{
      {RingChoice::kAuto, "auto"}, {RingChoice::kInner, "inner"}, {RingChoice::kOuter, "outer"}};
  a.Field({"ring", "",
           "on which side to pass: toward the turn's centre (left on a straight), away from it, or "
           "as RRT* finds it shorter"},
          options.ring, Need::kOptional, rings);
  a.Field({"min_speed", "m/s", "no slower than this to get past"}, options.min_speed,
          Need::kOptional, kPositive);
  a.Field({"max_lateral_acceleration", "m/s^2", "of the curve"}, options.max_lateral_acceleration,
          Need::kOptional, kPositive);
  a.Field({"steering_rate_share", "", "of the car's steering rate that the curve may ask for"},
          options.steering_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  a.Field({"comfortable_rate_share", "", "curves that ask for no more are preferred"},
          options.comfortable_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  a.Field({"rrt_iterations", "", "samples of RRT*"}, options.rrt_iterations, Need::kOptional,
          Range{.min = 0, .max = 1e6});
  a.Field({"rrt_step", "m", "from a node toward a sample at most"}, options.rrt_step,
          Need::kOptional, kPositive);
  a.Section({"search", "", "how the curve's control points are moved"}, options.search);
}

template <typename Archive>
void Visit(Archive& a, ListingAvoidanceOptions& options) {
  VisitAvoider(a, options);
  a.Field({"inner_width", "m",
           "free toward the turn's centre; the curve leads past on the wider side, this one of two "
           "alike"},
          options.inner_width, Need::kOptional, kNotNegative);
  a.Field({"outer_width", "m", "free on the other side"}, options.outer_width, Need::kOptional,
          kNotNegative);
  a.Field({"grid", "", "the arc in steps of 0.01 rad, as printed; else exact"},
          options.literal.grid, Need::kOptional);
  a.Field({"right_shift", "",
           "P_5 of a right turn shifted, as printed; else right turns are mirrored left ones"},
          options.literal.right_shift, Need::kOptional);
  a.Field({"right_angle_rule", "",
           "P_5 to P_7 of a turn of 90 degrees by rules of their own, as printed; else by that of "
           "all other angles"},
          options.literal.right_angle_rule, Need::kOptional);
}

}  // namespace trackbed

#pragma once

#include <cmath>
#include <limits>

#include "src/scenario/key_lister.h"
#include "src/scenario/visit_control.h"
#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/scenario/scenario.h"

/// The keys of `plan`: planners and avoiders with their options.
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

template <typename Archive>
void Visit(Archive& a, BezierAvoidanceOptions& options) {
  a.Field({"safe_distance", "m", "of the car's outline from obstacles"}, options.safe_distance,
          Need::kOptional, kNotNegative);
  a.Field({"delay", "s", "from learning of an obstacle to the new plan"}, options.delay,
          Need::kOptional, kNotNegative);
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
void Visit(Archive& a, FrenetWeights& weights) {
  a.Field({"k_dj", "s^5/m^2", "of lateral jerk"}, weights.k_dj, Need::kOptional, kNotNegative);
  a.Field({"k_d", "1/m^2", "of the offset at the end"}, weights.k_d, Need::kOptional, kNotNegative);
  a.Field({"k_dt", "1/s", "of time, laterally"}, weights.k_dt, Need::kOptional, kNotNegative);
  a.Field({"k_sj", "s^5/m^2", "of longitudinal jerk"}, weights.k_sj, Need::kOptional, kNotNegative);
  a.Field({"k_s", "1/m^2", "of the station missed"}, weights.k_s, Need::kOptional, kNotNegative);
  a.Field({"k_v", "s^2/m^2", "of the speed missed"}, weights.k_v, Need::kOptional, kNotNegative);
  a.Field({"k_st", "1/s", "of time, along the path"}, weights.k_st, Need::kOptional, kNotNegative);
  a.Field({"k_lat", "", "of all that is lateral"}, weights.k_lat, Need::kOptional, kNotNegative);
  a.Field({"k_lon", "", "of all that is along the path"}, weights.k_lon, Need::kOptional,
          kNotNegative);
  a.Field({"derivative_order", "", "of the integrals: 3 is jerk, 2 acceleration as in the slides"},
          weights.derivative_order, Need::kOptional, Range{.min = 2, .max = 3});
}

template <typename Archive>
void VisitLimits(Archive& a, FrenetLimits& limits) {
  a.Field({"max_lateral_acceleration", "m/s^2", "of a motion"}, limits.max_lateral_acceleration,
          Need::kOptional, kPositive);
  a.Field({"steering_rate_share", "", "of the car's steering rate that a motion may ask for"},
          limits.steering_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  a.Field({"speed_tolerance", "", "by which a motion may be faster than the mission, as a share"},
          limits.speed_tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

inline constexpr Key kEndOffsets{"end_offsets", "m", "from the route, that are tried"};
inline constexpr Key kSpeedFactors{"speed_factors", "", "of the wanted speed, that are tried"};
inline constexpr Range kOffsetRange{.min = -100.0, .max = 100.0};
inline constexpr Range kFactorRange{.min = 0.0, .max = 1.0};

template <typename Archive>
void Visit(Archive& a, FrenetOptions& options) {
  a.Field({"end_times", "s", "durations that are tried"}, options.end_times, Need::kOptional,
          Range{.max = 60.0, .above = 0.0});
  a.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  a.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  a.Field({"station_offsets", "m", "from where to stop or to follow, that are tried"},
          options.station_offsets, Need::kOptional, kOffsetRange);
  a.Field({"horizon", "s", "until when a motion must stay clear if it goes on as it ends"},
          options.horizon, Need::kOptional, Range{.min = 0.0, .max = 60.0});
  static const EnumNames<LateralMotion> laterals{{LateralMotion::kAuto, "auto"},
                                                 {LateralMotion::kOverTime, "over_time"},
                                                 {LateralMotion::kOverStation, "over_station"}};
  a.Field({"lateral", "",
           "whether it moves aside over time, over the way, or over the way when that is slow"},
          options.lateral, Need::kOptional, laterals);
  a.Field({"low_speed", "m/s", "below which 'auto' moves aside over the way"}, options.low_speed,
          Need::kOptional, kNotNegative);
  VisitLimits(a, options.limits);
  a.Section({"weights", "", "of the cost"}, options.weights);
  a.Field({"budget", "", "motions checked at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e9});
}

template <typename Archive>
void Visit(Archive& a, LatticeOptions& options) {
  a.Field({"layers", "", "of the lattice"}, options.layers, Need::kOptional,
          Range{.min = 1, .max = 100});
  a.Field({"spacing", "m", "between its layers"}, options.spacing, Need::kOptional, kPositive);
  a.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  a.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  VisitLimits(a, options.limits);
  a.Section({"weights", "", "of the cost"}, options.weights);
  a.Field({"budget", "", "edges checked at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e9});
}

/// How far the road reaches; a side that is not given has no end.
template <typename Archive>
void VisitRoadSide(Archive& a, const Key& key, double& width) {
  std::optional<double> side;
  if (std::isfinite(width)) {
    side = width;
  }
  a.Field(key, side, kPositive);
  width = side.value_or(std::numeric_limits<double>::infinity());
}

template <typename Archive>
void Visit(Archive& a, RoadWidths& road) {
  VisitRoadSide(a, {"left", "m", "of the route; without it there is no end"}, road.left);
  VisitRoadSide(a, {"right", "m", "of the route; without it there is no end"}, road.right);
}

/// Planners that find a way round by themselves, set to go forwards.
inline const std::vector<PlannerEntry>& DetourPlanners() {
  static const std::vector<PlannerEntry> table = [] {
    std::vector<PlannerEntry> fit;
    for (PlannerEntry entry : Planners()) {
      if (auto* hybrid = std::get_if<HybridAStarOptions>(&entry.defaults)) {
        hybrid->reverse = false;
      }
      if (entry.keeps_clear && !MayGoBackwards(entry.defaults)) {
        fit.push_back(entry);
      }
    }
    return fit;
  }();
  return table;
}

template <typename Archive>
void Visit(Archive& a, DetourChoice& choice) {
  a.Field({"attempts", "", "of a random planner, each with a seed of its own"}, choice.attempts,
          Need::kOptional, Range{.min = 1, .max = 1000});
  a.Field({"collision_penalty", "m", "for a way that is blocked"},
          choice.comparator.collision_penalty, Need::kOptional, kNotNegative);
  a.Field({"wind_weight", "", "of the wind along the way, in metres for metres"},
          choice.wind_weight, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, ReplanOptions& options) {
  a.Field({"period", "s", "between two looks at what is known"}, options.period, Need::kOptional,
          Range{.min = 0.05, .max = 60.0});
  a.Field({"look_ahead", "s", "for which the way must be clear, or another is looked for"},
          options.settings.look_ahead, Need::kOptional, Range{.min = 1.0, .max = 60.0});
  a.Field(kOutlineDistance, options.settings.safe_distance, Need::kOptional, kNotNegative);
  a.Section({"road", "", "how far it reaches beside the route, for the outline"},
            options.settings.road);
  a.Field({"gap", "m", "from bumper to bumper, behind what is in the way"}, options.settings.gap,
          Need::kOptional, kNotNegative);
  a.Field({"time_gap", "s", "besides, behind what moves"}, options.settings.time_gap,
          Need::kOptional, kNotNegative);
  a.Method({"along", "", "how motions along the route are found"}, options.along, AlongMethods(),
           Need::kOptional, [](auto&) {});
  a.Method({"detour", "", "another way to the goal, when no motion along the route leads past"},
           options.detour, DetourPlanners(), Need::kOptional, [](auto&) {});
  a.Section({"comparator", "", "what decides for a detour, or against it"}, options.comparator);
  if (options.detour && !options.comparator) {
    options.comparator.emplace();
  }
}

/// The layers of a plan, each under its own key.
struct PlanLayers {
  std::optional<PlannerOptions>& global;
  std::optional<AvoiderOptions>& avoid;
  std::optional<ReplanOptions>& replan;
};

inline constexpr Key kPlan{"plan", "", "how the path is made; without it there is none to follow"};
inline constexpr Key kAvoid{"avoid", "", "what leads the path around obstacles that stand in it"};
inline constexpr Key kReplan{"replan", "", "how to plan again while driving"};

template <typename Archive>
void Visit(Archive& a, PlanLayers& layers) {
  a.Method({"global", "", "the planner of the whole path"}, layers.global, Planners(),
           Need::kRequired, [](auto&) {});
  a.Method(kAvoid, layers.avoid, Avoiders(), Need::kOptional, [](auto&) {});
  a.Section(kReplan, layers.replan);
}

/// `plan: {method: …}` is short for `plan: {global: {method: …}}`.
inline void VisitPlan(YamlReader& a, std::optional<PlanSpec>& plan) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  std::optional<ReplanOptions> replan;
  if (a.HasOneOf(kPlan.name, {"global", "avoid", "replan"})) {
    PlanLayers layers{global, avoid, replan};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional, [](auto&) {});
  }
  if (global) {
    plan = {*global, avoid, replan};
  }
}

inline void VisitPlan(YamlWriter& a, std::optional<PlanSpec>& plan) {
  if (!plan) {
    return;
  }
  std::optional<PlannerOptions> global = plan->global;
  if (plan->avoid || plan->replan) {
    PlanLayers layers{global, plan->avoid, plan->replan};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional, [](auto&) {});
  }
}

inline void VisitPlan(KeyLister& a, std::optional<PlanSpec>&) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  std::optional<ReplanOptions> replan = ReplanOptions{};
  a.Method(kPlan, global, Planners(), Need::kOptional, [&](KeyLister& inner) {
    inner.Add(
        {"global", "", "the keys of this section, when `avoid` or `replan` stands beside them"},
        "section", Need::kOptional, "", "");
    inner.Method(kAvoid, avoid, Avoiders(), Need::kOptional, [](auto&) {});
    inner.Section(kReplan, replan);
  });
}

}  // namespace trackbed

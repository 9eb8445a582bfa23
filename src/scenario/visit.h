#pragma once

#include "src/scenario/key_lister.h"
#include "src/scenario/visit_control.h"
#include "src/scenario/visit_disturb.h"
#include "src/scenario/visit_manoeuvre.h"
#include "src/scenario/visit_world.h"
#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/scenario/scenario.h"

/// The keys of a scenario, each named once for reading, writing and listing alike.
namespace trackbed {

inline constexpr Key kVehicleSection{"vehicle", "", "the car"};
inline constexpr Key kRenderSection{"render", "", "how the run is filmed"};

inline Names PlantNames() {
  Names names;
  for (const PlantEntry& entry : Plants()) {
    names.emplace_back(entry.name);
  }
  return names;
}

template <typename Archive>
void Visit(Archive& a, VehicleSpec& vehicle) {
  a.Field({"model", "", "a name under models/, or a path relative to this file"}, vehicle.model,
          Need::kOptional);
  static const EnumNames<TyreLaw> laws{{TyreLaw::kContact, "contact"},
                                       {TyreLaw::kMagicFormula, "magic_formula"}};
  a.Field({"tyre", "", "what holds the plant mujoco to the road"}, vehicle.tyre, Need::kOptional,
          laws);
  a.Field({"steering_rate", "rad/s", "of the road wheels, instead of the car's own"},
          vehicle.steering_rate, Range{.max = 10.0, .above = 0.0});
}

template <typename Archive>
void Visit(Archive& a, StartSpec& start) {
  a.Field({"x", "m", "rear axle at the start; else the first waypoint's, or 0"}, start.x, kMap);
  a.Field({"y", "m", "likewise"}, start.y, kMap);
  a.Field({"yaw", "rad", "heading at the start; else along the first leg, or 0"}, start.yaw);
  a.Field({"speed", "m/s",
           "speed at the start; else the recording's, that of control.speed.over_time, or the "
           "mission's"},
          start.speed, kSpeed);
  a.Field({"steering", "rad",
           "bicycle angle of wheels and actuator at the start; else 0, or what was recorded if it "
           "is prescribed"},
          start.steering, kSteering);
}

template <typename Archive>
void Visit(Archive& a, MissionSpec& mission) {
  std::optional<double> speed = mission.speed > 0.0 ? std::optional(mission.speed) : std::nullopt;
  a.Field({"speed", "m/s",
           "the speed to keep between start and goal; needed by a plan, and unless something else "
           "gives the speed at the start"},
          speed, Range{.min = 0.1, .max = 100.0});
  mission.speed = speed.value_or(0.0);
  a.Field({"waypoints", "m", "the route, at least three; needed by a plan by fillet"},
          mission.waypoints, Need::kOptional);
  a.Field(
      {"duration", "s",
       "ends the drive; needed without a plan unless a recording over time ends, refused with one"},
      mission.duration, kPositive);
  a.Section({"start", "", "where and how the car starts"}, mission.start);
}

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

/// The layers of a plan, each under its own key.
struct PlanLayers {
  std::optional<PlannerOptions>& global;
  std::optional<AvoiderOptions>& avoid;
};

inline constexpr Key kPlan{"plan", "", "how the path is made; without it there is none to follow"};
inline constexpr Key kAvoid{"avoid", "", "what leads the path around obstacles that stand in it"};

template <typename Archive>
void Visit(Archive& a, PlanLayers& layers) {
  a.Method({"global", "", "the planner of the whole path"}, layers.global, Planners(),
           Need::kRequired, [](auto&) {});
  a.Method(kAvoid, layers.avoid, Avoiders(), Need::kOptional, [](auto&) {});
}

/// `plan: {method: …}` is short for `plan: {global: {method: …}}`.
inline void VisitPlan(YamlReader& a, std::optional<PlanSpec>& plan) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  if (a.HasOneOf(kPlan.name, {"global", "avoid"})) {
    PlanLayers layers{global, avoid};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional, [](auto&) {});
  }
  if (global) {
    plan = {*global, avoid};
  }
}

inline void VisitPlan(YamlWriter& a, std::optional<PlanSpec>& plan) {
  if (!plan) {
    return;
  }
  std::optional<PlannerOptions> global = plan->global;
  if (plan->avoid) {
    PlanLayers layers{global, plan->avoid};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional, [](auto&) {});
  }
}

inline void VisitPlan(KeyLister& a, std::optional<PlanSpec>&) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  a.Method(kPlan, global, Planners(), Need::kOptional, [&](KeyLister& inner) {
    inner.Add({"global", "", "the keys of this section, when `avoid` stands beside them"},
              "section", Need::kOptional, "", "");
    inner.Method(kAvoid, avoid, Avoiders(), Need::kOptional, [](auto&) {});
  });
}

template <typename Archive>
void Visit(Archive& a, DriveSpec& drive) {
  a.Field({"plants", "", "what to drive the plan on, in this order"}, drive.plants, Need::kOptional,
          PlantNames());
  static const EnumNames<SteeringInput> inputs{{SteeringInput::kActuator, "actuator"},
                                               {SteeringInput::kPrescribed, "prescribed"}};
  a.Field({"steering", "",
           "how the wanted angle reaches the road wheels: through the car's "
           "rate-limited actuator, or exactly"},
          drive.steering, Need::kOptional, inputs);
  a.Field({"timestep", "s", "of the physics"}, drive.timestep, Need::kOptional,
          Range{.min = 1e-5, .max = 0.02});
  a.Field({"control_period", "s", "between two commands; a whole number of timesteps"},
          drive.control_period, Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field({"state_period", "s", "between two states logged for the film"}, drive.state_period,
          Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field({"time_limit", "s", "simulated time after which a drive is given up"}, drive.time_limit,
          Need::kOptional, Range{.max = 1e5, .above = 0.0});
}

template <typename Archive>
void Visit(Archive& a, MetricExpectation& expect) {
  a.Field({"metric", "", "path into the plant's entry of metrics.json: manoeuvre.margin"},
          expect.metric, Need::kRequired);
  a.Field({"min", "", "smallest value, in the metric's unit"}, expect.min);
  a.Field({"max", "", "largest value, in the metric's unit"}, expect.max);
  a.Field({"equals", "", "the very value: a number, a text, true or false"}, expect.equals);
}

template <typename Archive>
void Visit(Archive& a, PlantExpectation& expect) {
  a.Field({"reach_goal", "m", "largest distance to the goal at the end"}, expect.reach_goal,
          kNotNegative);
  a.Field({"max_cross_track", "m", "largest distance from the path"}, expect.max_cross_track,
          kNotNegative);
  a.Field({"rms_cross_track", "m", "largest root mean square of it"}, expect.rms_cross_track,
          kNotNegative);
  a.Field({"max_heading_error", "rad", "largest angle to the path"}, expect.max_heading_error,
          kNotNegative);
  a.Field({"min_clearance", "m", "smallest distance of the car's outline from an obstacle"},
          expect.min_clearance, kNotNegative);
  a.Field({"collision", "", "whether the car hits an obstacle"}, expect.collision);
  a.List({"metrics", "", "bounds on whatever else was measured"}, expect.metrics);
}

template <typename Archive>
void Visit(Archive& a, BetweenExpectation& expect) {
  a.Field({"plants", "", "the two plants to compare"}, expect.plants, Need::kRequired,
          PlantNames());
  a.Field({"position_max", "m", "largest distance between them at equal station"},
          expect.position_max, kNotNegative);
  a.Field({"heading_max", "rad", "largest angle between them at equal station"}, expect.heading_max,
          kNotNegative);
}

inline void VisitPlants(YamlReader& a, Expectations& expect) {
  for (const std::string& plant : PlantNames()) {
    PlantExpectation own;
    if (a.SectionIfThere(plant, own)) {
      expect.plants.emplace_back(plant, own);
    }
  }
}

inline void VisitPlants(YamlWriter& a, Expectations& expect) {
  for (auto& [plant, own] : expect.plants) {
    a.Section({plant.c_str(), "", ""}, own);
  }
}

inline void VisitPlants(KeyLister& a, Expectations&) {
  for (const std::string& plant : PlantNames()) {
    a.Add({plant.c_str(), "", "the bounds above, for this plant alone"}, "section", Need::kOptional,
          "", "");
  }
}

template <typename Archive>
void Visit(Archive& a, Expectations& expect) {
  Visit(a, expect.all);
  VisitPlants(a, expect);
  a.List({"between", "", "how far two plants may part"}, expect.between);
}

template <typename Archive>
void Visit(Archive& a, RenderSpec& render) {
  a.Field({"camera", "", "point of view; `trackbed list cameras` has them"}, render.camera,
          Need::kOptional);
  a.Pair({"size", "pixels", "width and height, even"}, render.width, render.height,
         Range{.min = 64, .max = 7680});
  a.Field({"fps", "1/s", "frames per second of the run"}, render.fps, Need::kOptional,
          Range{.min = 1.0, .max = 240.0});
}

template <typename Archive>
void Visit(Archive& a, Scenario& scenario) {
  int schema = 1;
  a.Field({"schema", "", "version of this format"}, schema, Need::kRequired,
          Range{.min = 1, .max = 1});
  a.Identifier({"name", "", "names the run and its folder"}, scenario.name);
  a.Field({"seed", "", "of every random choice"}, scenario.seed, Need::kOptional);
  a.Section(kVehicleSection, scenario.vehicle);
  a.Section({"mission", "", "where to drive, and how fast"}, scenario.mission, Need::kRequired);
  a.Section(kWorldSection, scenario.world);
  VisitPlan(a, scenario.plan);
  std::optional<ControllerOptions> steering = scenario.control.steering;
  a.Method({"control", "", "what steers and what keeps the speed"}, steering, Controllers(),
           Need::kOptional, [&](auto& inner) {
             inner.Section({"speed", "", "how the speed is kept"}, scenario.control.speed);
           });
  scenario.control.steering = *steering;
  a.Method({"manoeuvre", "", "the standard manoeuvre that the drive is evaluated as"},
           scenario.manoeuvre, Manoeuvres(), Need::kOptional, [](auto&) {});
  a.Section({"drive", "", "what is driven, and in which steps"}, scenario.drive);
  a.Section({"disturb", "", "what goes wrong on the drive; nothing unless it is asked for"},
            scenario.disturb);
  a.Section({"expect", "",
             "bounds that the run must keep, on every plant; what is not given is not asked"},
            scenario.expect);
  a.Section(kRenderSection, scenario.render);
}

}  // namespace trackbed

#pragma once

#include <algorithm>

#include "src/scenario/visit_disturb.h"
#include "src/scenario/visit_manoeuvre.h"
#include "src/scenario/visit_plan.h"
#include "src/scenario/visit_world.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/scenario/scenario.h"

/// The keys of a scenario, each named once for reading, writing and listing alike.
namespace trackbed {

inline constexpr Key kVehicleSection{"vehicle", "", "the car"};
inline constexpr Key kExpectSection{
    "expect", "", "bounds that the run must keep, on every plant; what is not given is not asked"};
inline constexpr Key kRenderSection{"render", "", "how the run is filmed"};

inline Names PlantNames() {
  Names names;
  for (const PlantEntry& entry : Plants()) {
    names.emplace_back(entry.name);
  }
  return names;
}

inline void Visit(KeyVisitor& a, VehicleSpec& vehicle) {
  a.Field({"model", "", "a name under models/, or a path relative to this file"}, vehicle.model,
          Need::kOptional);
  static const EnumNames<TyreLaw> laws{{TyreLaw::kAuto, "auto"},
                                       {TyreLaw::kContact, "contact"},
                                       {TyreLaw::kMagicFormula, "magic_formula"}};
  a.Field(
      {"tyre", "",
       "what holds the plant mujoco to the road; auto: the Magic Formula for cars that have tyre "
       "coefficients, else their contacts"},
      vehicle.tyre, Need::kOptional, laws);
  a.Field({"steering_rate", "rad/s", "of the road wheels, instead of the car's own"},
          vehicle.steering_rate, Range{.max = 10.0, .above = 0.0});
}

inline void Visit(KeyVisitor& a, StartSpec& start) {
  a.Field({"x", "m", "rear axle at the start; else the first waypoint's, or 0"}, start.x, kMap);
  a.Field({"y", "m", "likewise"}, start.y, kMap);
  a.Field({"yaw", "rad",
           "heading at the start; else the first of `headings`, along the first leg, or 0"},
          start.yaw);
  a.Field({"speed", "m/s",
           "speed at the start; else the recording's, that of control.speed.over_time, or the "
           "mission's"},
          start.speed, kSpeedRange);
  a.Field(
      {"steering", "rad",
       "bicycle angle of wheels and actuator at the start; else the plan's neutral_steering, or 0, "
       "or what was recorded if it is prescribed"},
      start.steering, kSteering);
}

inline void Visit(KeyVisitor& a, MissionSpec& mission) {
  std::optional<double> speed = mission.speed > 0.0 ? std::optional(mission.speed) : std::nullopt;
  a.Field({"speed", "m/s",
           "the speed to keep between start and goal; needed by a plan, and unless something else "
           "gives the speed at the start"},
          speed, Range{.min = 0.1, .max = 100.0});
  mission.speed = speed.value_or(0.0);
  a.Field({"waypoints", "m",
           "the route: at least three for a plan by fillet, at least two for one around obstacles"},
          mission.waypoints, Need::kOptional);
  a.Field({"headings", "rad",
           "of the car at each waypoint; else along the last leg at the goal, from the stop before "
           "to the stop after on the way"},
          mission.headings, Need::kOptional);
  a.Field(
      {"duration", "s",
       "ends the drive; needed without a plan unless a recording over time ends, refused with one"},
      mission.duration, kPositive);
  a.Section({"start", "", "where and how the car starts"}, mission.start);
}

inline void Visit(KeyVisitor& a, DriveSpec& drive) {
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
  a.Field({"goal_tolerance", "",
           "how near a car at rest must be to its goal, as a share of its length"},
          drive.goal_tolerance, Need::kOptional, Range{.max = 10.0, .above = 0.0});
  a.Field({"goal_heading_tolerance", "rad",
           "largest heading error there, for missions with `headings`"},
          drive.goal_heading_tolerance, Need::kOptional, Range{.max = 3.2, .above = 0.0});
}

inline void Visit(KeyVisitor& a, MetricExpectation& expect) {
  a.Field({"metric", "", "path into the plant's entry of metrics.json: manoeuvre.margin"},
          expect.metric, Need::kRequired);
  a.Field({"min", "", "smallest value, in the metric's unit"}, expect.min);
  a.Field({"max", "", "largest value, in the metric's unit"}, expect.max);
  a.Field({"equals", "", "the very value: a number, a text, true or false"}, expect.equals);
}

inline void Visit(KeyVisitor& a, PlantExpectation& expect) {
  a.Field({"reach_goal", "m", "largest distance to the goal at the end"}, expect.reach_goal,
          kNonNegative);
  a.Field({"max_cross_track", "m", "largest distance from the path"}, expect.max_cross_track,
          kNonNegative);
  a.Field({"rms_cross_track", "m", "largest root mean square of it"}, expect.rms_cross_track,
          kNonNegative);
  a.Field({"max_heading_error", "rad", "largest angle to the path"}, expect.max_heading_error,
          kNonNegative);
  a.Field({"min_clearance", "m", "smallest distance of the car's outline from an obstacle"},
          expect.min_clearance, kNonNegative);
  a.Field({"collision", "", "whether the car hits an obstacle"}, expect.collision);
  a.List({"metrics", "", "bounds on whatever else was measured"}, expect.metrics);
}

inline void Visit(KeyVisitor& a, BetweenExpectation& expect) {
  a.Field({"plants", "", "the two plants to compare"}, expect.plants, Need::kRequired,
          PlantNames());
  a.Field({"position_max", "m", "largest distance between them at equal station"},
          expect.bounds.position_max, kNonNegative);
  a.Field({"heading_max", "rad", "largest angle between them at equal station"},
          expect.bounds.heading_max, kNonNegative);
  a.Field({"yaw_rate_max", "rad/s", "largest difference of their yaw rates at equal station"},
          expect.bounds.yaw_rate_max, kNonNegative);
  a.Field({"steering_max", "rad",
           "largest difference of their measured steering angles at equal station"},
          expect.bounds.steering_max, kNonNegative);
}

inline void VisitPlants(KeyVisitor& a, Expectations& expect) {
  for (const std::string& plant : PlantNames()) {
    const Key key{plant.c_str(), "", "the bounds above, for this plant alone"};
    if (a.mode() == KeyVisitor::Mode::kList) {
      a.Mention(key, "section");
      continue;
    }
    const auto given = std::find_if(expect.plants.begin(), expect.plants.end(),
                                    [&](const auto& entry) { return entry.first == plant; });
    std::optional<PlantExpectation> own;
    if (given != expect.plants.end()) {
      own = given->second;
    }
    a.Section(key, own);
    if (own && given == expect.plants.end()) {
      expect.plants.emplace_back(plant, *own);
    }
  }
}

inline void Visit(KeyVisitor& a, Expectations& expect) {
  Visit(a, expect.all);
  VisitPlants(a, expect);
  a.List({"between", "", "how far two plants may part"}, expect.between);
}

inline void Visit(KeyVisitor& a, RenderSpec& render) {
  a.Field({"camera", "", "point of view; `trackbed list cameras` has them"}, render.camera,
          Need::kOptional);
  a.Pair({"size", "pixels", "width and height, even"}, render.width, render.height,
         Range{.min = 64, .max = 7680});
  a.Field({"fps", "1/s", "frames per second of the run"}, render.fps, Need::kOptional,
          Range{.min = 1.0, .max = 240.0});
}

inline void Visit(KeyVisitor& a, Scenario& scenario) {
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
           Need::kOptional, [&](KeyVisitor& inner) {
             inner.Section({"speed", "", "how the speed is kept"}, scenario.control.speed);
           });
  scenario.control.steering = *steering;
  a.Method({"manoeuvre", "", "the standard maneuver that the drive is evaluated as"},
           scenario.manoeuvre, Manoeuvres(), Need::kOptional);
  a.Section({"drive", "", "what is driven, and in which steps"}, scenario.drive);
  a.Section({"disturb", "", "what goes wrong on the drive; nothing unless it is asked for"},
            scenario.disturb);
  a.Section(kExpectSection, scenario.expect);
  a.Section(kRenderSection, scenario.render);
}

}  // namespace trackbed

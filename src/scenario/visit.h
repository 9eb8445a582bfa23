#pragma once

#include <algorithm>

#include "src/scenario/visit_disturb.h"
#include "src/scenario/visit_maneuver.h"
#include "src/scenario/visit_plan.h"
#include "src/scenario/visit_vehicle.h"
#include "src/scenario/visit_world.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/scenario.h"

/// Declares the keys of a scenario file, for reading, writing and listing the keys.
namespace trackbed {

inline constexpr Key kExpectSection{
    "expect", "", "bounds that every plant must meet; only those given are checked"};
inline constexpr Key kRenderSection{"render", "", "video settings"};

inline void Visit(KeyVisitor& a, StartSpec& start) {
  a.Field({"x", "m",
           "initial position of the rear axle; default: that of the record, first waypoint, or 0"},
          start.x, kPlace);
  a.Field({"y", "m",
           "initial position of the rear axle; default: that of the record, first waypoint, or 0"},
          start.y, kPlace);
  a.Field({"yaw", "rad",
           "initial heading; default: that of the record, the first of `headings`, along the first "
           "leg, or 0"},
          start.yaw, kDirection);
  a.Field(
      {"speed", "m/s",
       "initial speed; default: that of the recording or record, of control.speed.over_time, or "
       "of the mission"},
      start.speed, kSpeedRange);
  a.Field({"steering", "rad",
           "initial bicycle angle of wheels and actuator; default: that of the start of a given "
           "route (path_file, course, lane_route, tracks), the plan's neutral_steering, or 0; with "
           "a record or prescribed steering, the recorded angle"},
          start.steering, kSteering);
  a.Field({"hitch_angle", "rad",
           "initial yaw of the trailer relative to the car, positive to the left; default: 0"},
          start.hitch_angle, Range{.min = -3.0, .max = 3.0});
}

inline constexpr Key kMissionSection{"mission", "", "route and speed"};

inline void Visit(KeyVisitor& a, TrackSpec& track) {
  a.Field({"file", "", "track: a CSV file of points and widths, relative to this file"}, track.file,
          Need::kRequired);
  a.Field({"laps", "", "laps that are timed"}, track.laps, Need::kOptional,
          Range{.min = 1, .max = 1000});
  a.Field({"smoothing", "m",
           "bends of the center line shorter than this are smoothed out; default: four times the "
           "mean distance of the points"},
          track.smoothing, Range{.max = 1000.0, .above = 0.0});
  a.Field({"width", "m",
           "width of the track, half on either side of the center line; for files without widths"},
          track.width, Range{.max = 2000.0, .above = 0.0});
}

inline void Visit(KeyVisitor& a, LanePlace& place) {
  a.Field({"road", "", "id of the road"}, place.road, Need::kRequired);
  a.Field({"lane", "", "number of the lane: negative to the right of the center lane"}, place.lane,
          Need::kRequired, Range{.min = -100, .max = 100});
  a.Field({"s", "m", "station along the road"}, place.s, Need::kRequired,
          Range{.min = 0.0, .max = 1e6});
}

inline void Visit(KeyVisitor& a, MissionSpec& mission) {
  std::optional<double> speed = mission.speed == 0.0 ? std::nullopt : std::optional(mission.speed);
  a.Field({"speed", "m/s",
           "target speed between start and goal; required with a plan, and where nothing else sets "
           "the initial speed"},
          speed, Range{.min = 0.1, .max = 100.0});
  mission.speed = speed.value_or(0.0);
  a.Field({"waypoints", "m", "route; at least two points"}, mission.waypoints, Need::kOptional,
          kPlaces);
  a.Field(
      {"headings", "rad",
       "heading of the car at each waypoint; default: along the last leg at the goal, at stops in "
       "between that of the circle through the previous, this and the next stop"},
      mission.headings, Need::kOptional, kDirection);
  a.List({"route", "",
          "places on lanes of world.road_network that the route leads over, at least two; for the "
          "planner lane_route"},
         mission.route);
  a.Field({"duration", "s",
           "end of the run; required without a plan unless a recording or record ends it, not "
           "allowed with a plan"},
          mission.duration, kPositive);
  a.Method(
      {"speed_profile", "", "how the plan's speeds are chosen; default: constant_acceleration"},
      mission.speed_profile, SpeedProfiles(), Need::kOptional);
  a.Section({"track", "", "closed track to drive laps on, for planners that follow one"},
            mission.track);
  a.Section({"start", "", "initial state of the car"}, mission.start);
}

inline void Visit(KeyVisitor& a, RecordSpec& record) {
  a.Field({"file", "", "log of a real vehicle, a CSV file; or the record.csv of a run"},
          record.file, Need::kRequired);
  a.Field({"map", "", "how to read the log: a file; not for a record.csv"}, record.map);
  a.Field({"from", "s", "what is before is left out; default: the map's"}, record.from,
          kNonNegative);
  a.Field({"to", "s", "what is after is left out; default: the map's"}, record.to, kPositive);
  a.Field({"ground", "", "banked track or open road, a CSV file, whose surface is the ground"},
          record.ground);
  static const EnumNames<ReplaySteering> steering{{ReplaySteering::kCommand, "command"},
                                                  {ReplaySteering::kMeasured, "measured"}};
  a.Field({"steering", "", "what a replay steers with: the recorded command or measured angle"},
          record.steering, Need::kOptional, steering);
  static const EnumNames<ReplayDrive> drive{{ReplayDrive::kSpeed, "speed"},
                                            {ReplayDrive::kThrottle, "throttle"}};
  a.Field({"drive", "", "what it drives with: the recorded speed or throttle"}, record.drive,
          Need::kOptional, drive);
  a.Field({"windows", "s",
           "horizons: every so often plants restart at the recorded state and predict so far"},
          record.windows, Need::kOptional, Range{.max = 1e4, .above = 0.0});
  a.Field({"min_speed", "m/s", "moments and windows in which the car was slower are not measured"},
          record.min_speed, Need::kOptional, kSpeedRange);
  a.Field({"notes", "", "what was done to the log, a line for each remark; runs write it"},
          record.notes);
}

inline void Visit(KeyVisitor& a, DriveSpec& drive) {
  a.Field({"plants", "", "plants to run, in this order"}, drive.plants, Need::kOptional,
          DrivenPlantNames());
  static const EnumNames<SteeringInput> inputs{{SteeringInput::kActuator, "actuator"},
                                               {SteeringInput::kPrescribed, "prescribed"}};
  a.Field({"steering", "",
           "steering input: commanded, through the rate-limited actuator, or prescribed exactly"},
          drive.steering, Need::kOptional, inputs);
  a.Field({"timestep", "s", "physics timestep"}, drive.timestep, Need::kOptional,
          Range{.min = 1e-5, .max = 0.02});
  a.Field({"control_period", "s", "control period; a whole number of timesteps"},
          drive.control_period, Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field({"state_period", "s", "logging period of the states for the video"}, drive.state_period,
          Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field({"time_limit", "s", "simulated time after which a run is stopped"}, drive.time_limit,
          Need::kOptional, Range{.max = 1e5, .above = 0.0});
  a.Field({"goal_tolerance", "",
           "largest distance to the goal at rest that counts as arrived, as a fraction of the "
           "car's length"},
          drive.goal_tolerance, Need::kOptional, Range{.max = 10.0, .above = 0.0});
  a.Field(
      {"goal_heading_tolerance", "rad",
       "largest heading error at the goal that counts as arrived, for missions with `headings`"},
      drive.goal_heading_tolerance, Need::kOptional, Range{.max = 3.2, .above = 0.0});
}

inline void Visit(KeyVisitor& a, MetricExpectation& expect) {
  a.Field({"metric", "",
           "path of the metric in the plant's entry of metrics.json, such as maneuver.margin"},
          expect.metric, Need::kRequired);
  a.Field({"min", "", "minimum, in the metric's unit"}, expect.min);
  a.Field({"max", "", "maximum, in the metric's unit"}, expect.max);
  a.Field({"equals", "", "exact value: a number, a text, true or false"}, expect.equals);
}

inline void Visit(KeyVisitor& a, RequirementExpectation& expect) {
  a.Field({"name", "", "of a-z, 0-9 and '_': requirements.NAME.robustness is its metric"},
          expect.name, Need::kRequired);
  a.Field({"formula", "",
           "temporal logic over the columns of the log, such as always abs(cross_track_m) < 0.5"},
          expect.formula, Need::kRequired);
}

inline void Visit(KeyVisitor& a, PlantExpectation& expect) {
  a.Field({"reach_goal", "m", "maximum distance to the goal at the end"}, expect.reach_goal,
          kNonNegative);
  a.Field({"max_cross_track", "m", "maximum cross-track error"}, expect.max_cross_track,
          kNonNegative);
  a.Field({"rms_cross_track", "m", "maximum root mean square of the cross-track error"},
          expect.rms_cross_track, kNonNegative);
  a.Field({"max_hitch_angle", "rad", "largest magnitude of the trailer's hitch angle"},
          expect.max_hitch_angle, Range{.max = 3.2, .above = 0.0});
  a.Field({"max_heading_error", "rad", "maximum heading error"}, expect.max_heading_error,
          kNonNegative);
  a.Field({"min_clearance", "m",
           "minimum distance of the car's footprint from obstacles, blocked cells of the map, and "
           "the edges of the track or of the roads of mission.route"},
          expect.min_clearance, kNonNegative);
  a.Field({"collision", "", "whether the car must hit an obstacle"}, expect.collision);
  a.List({"metrics", "", "bounds on other metrics"}, expect.metrics);
  a.List({"requirements", "", "formulas that the log must satisfy"}, expect.requirements);
}

inline void Visit(KeyVisitor& a, BetweenExpectation& expect) {
  a.Field({"plants", "", "the two plants to compare"}, expect.plants, Need::kRequired,
          DrivenPlantNames());
  a.Field({"position_max", "m", "maximum position difference at equal station"},
          expect.bounds.position_max, kNonNegative);
  a.Field({"heading_max", "rad", "maximum heading difference at equal station"},
          expect.bounds.heading_max, kNonNegative);
  a.Field({"yaw_rate_max", "rad/s", "maximum yaw rate difference at equal station"},
          expect.bounds.yaw_rate_max, kNonNegative);
  a.Field({"steering_max", "rad",
           "maximum difference of the measured steering angles at equal station"},
          expect.bounds.steering_max, kNonNegative);
}

inline void VisitPlants(KeyVisitor& a, Expectations& expect) {
  for (const std::string& plant : DrivenPlantNames()) {
    const Key key{plant.c_str(), "", "the bounds above, for this plant only"};
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
  a.List({"between", "", "bounds on the difference between two plants"}, expect.between);
}

inline void Visit(KeyVisitor& a, RenderSpec& render) {
  a.Field({"camera", "", "camera; see `trackbed list cameras`"}, render.camera, Need::kOptional);
  a.Pair({"size", "pixels", "width and height, even"}, render.width, render.height,
         Range{.min = 64, .max = 7680});
  a.Field({"fps", "1/s", "frames per second of the run"}, render.fps, Need::kOptional,
          Range{.min = 1.0, .max = 240.0});
}

inline void VisitOrigin(KeyVisitor& a, std::optional<Vec2>& origin) {
  std::vector<double> numbers;
  if (origin) {
    numbers = {origin->x(), origin->y()};
  }
  a.Field({"origin", "m",
           "local origin [x, y] in whole meters; default: chosen near the scenario's places if a "
           "coordinate exceeds 1e5 m, otherwise none"},
          numbers, Need::kOptional, Range{.min = -1e8, .max = 1e8});
  if (a.mode() == KeyVisitor::Mode::kRead) {
    origin = numbers.size() == 2 ? std::optional(Vec2(numbers[0], numbers[1])) : std::nullopt;
  }
}

inline void Visit(KeyVisitor& a, Scenario& scenario) {
  int schema = 1;
  a.Field({"schema", "", "version of this format"}, schema, Need::kRequired,
          Range{.min = 1, .max = 1});
  a.Identifier({"name", "", "name of the scenario and its output folder"}, scenario.name);
  a.Field({"seed", "", "seed of all random numbers"}, scenario.seed, Need::kOptional);
  VisitOrigin(a, scenario.origin);
  a.Section(kVehicleSection, scenario.vehicle);
  a.Section(kMissionSection, scenario.mission, Need::kRequired);
  a.Section({"record", "", "recorded drive of a real vehicle, to be replayed and compared with"},
            scenario.record);
  a.Section(kWorldSection, scenario.world);
  VisitPlan(a, scenario.plan);
  static const EnumNames<ActuatorKnowledge> actuators{{ActuatorKnowledge::kModel, "model"},
                                                      {ActuatorKnowledge::kIgnore, "ignore"}};
  std::optional<ControllerOptions> steering = scenario.control.steering;
  a.Method({"control", "", "steering and speed controllers"}, steering, Controllers(),
           Need::kOptional, [&](KeyVisitor& inner) {
             inner.Section({"speed", "", "speed controller"}, scenario.control.speed);
             inner.Field({"actuator", "",
                          "whether path-following controllers account for dead time, lag, backlash "
                          "and calibration curve of the car's steering"},
                         scenario.control.actuator, Need::kOptional, actuators);
           });
  scenario.control.steering = *steering;
  a.Method({"maneuver", "", "standard maneuver as which the run is evaluated"}, scenario.maneuver,
           Maneuvers(), Need::kOptional);
  a.Section({"drive", "", "plants, timesteps and limits of the run"}, scenario.drive);
  a.Section({"disturb", "", "disturbances and faults; default: none"}, scenario.disturb);
  a.Section(kExpectSection, scenario.expect);
  a.Section(kRenderSection, scenario.render);
}

}  // namespace trackbed

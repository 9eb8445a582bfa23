#pragma once

#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/scenario/scenario.h"

/// The keys of a scenario, each named once for reading and writing alike.
namespace trackbed {

inline constexpr Range kPositive{.above = 0.0};
inline constexpr Range kNotNegative{.min = 0.0};

inline constexpr Range kMap{.min = -1e5, .max = 1e5};  // [m]; beyond any route

inline Names PlantNames() {
  Names names;
  for (const PlantEntry& entry : Plants()) {
    names.emplace_back(entry.name);
  }
  return names;
}

template <typename Archive>
void Visit(Archive& a, VehicleSpec& vehicle) {
  a.Field("model", vehicle.model, Need::kOptional);
  a.Field("tyre", vehicle.tyre, Need::kOptional, Names{"contact"});
}

template <typename Archive>
void Visit(Archive& a, StartSpec& start) {
  a.Field("x", start.x, kMap);
  a.Field("y", start.y, kMap);
  a.Field("yaw", start.yaw);
  a.Field("speed", start.speed, Range{.min = 0.0, .max = 100.0});
  a.Field("steering", start.steering, Need::kOptional, Range{.min = -1.5, .max = 1.5});
}

template <typename Archive>
void Visit(Archive& a, MissionSpec& mission) {
  a.Field("speed", mission.speed, Need::kRequired, Range{.min = 0.1, .max = 100.0});
  a.Field("waypoints", mission.waypoints, Need::kOptional);
  a.Field("duration", mission.duration, kPositive);
  a.Section("start", mission.start);
}

template <typename Archive>
void Visit(Archive& a, World& world) {
  a.Field("friction", world.friction, Need::kOptional, Range{.max = 10.0, .above = 0.0});
  a.List("obstacles", world.obstacles);
}

/// The keys of `box`.
struct BoxKeys {
  Obstacle& obstacle;
};

template <typename Archive>
void Visit(Archive& a, BoxKeys& keys) {
  OrientedBox& box = keys.obstacle.footprint;
  const Range size{.max = 1e4, .above = 0.0};
  a.Field("x", box.centre.x, Need::kRequired, kMap);
  a.Field("y", box.centre.y, Need::kRequired, kMap);
  a.Field("yaw", box.centre.yaw, Need::kOptional);
  a.Field("length", box.length, Need::kRequired, size);
  a.Field("width", box.width, Need::kRequired, size);
  a.Field("height", keys.obstacle.height, Need::kOptional, size);
}

template <typename Archive>
void Visit(Archive& a, Obstacle& obstacle) {
  BoxKeys keys{obstacle};
  a.Section("box", keys, Need::kRequired);
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
  a.Field("method", options.method, Need::kOptional, methods);
  a.Field("population", options.population, Need::kOptional, Range{.min = 3, .max = 1e5});
  a.Field("evaluations", options.evaluations, Need::kOptional, Range{.min = 0, .max = 1e8});
  a.Field("tolerance", options.tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

template <typename Archive>
void Visit(Archive& a, DrivenWeights& weights) {
  a.Field("position", weights.position, Need::kOptional, kNotNegative);
  a.Field("heading", weights.heading, Need::kOptional, kNotNegative);
  a.Field("end", weights.end, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, FilletOptions& options) {
  a.Field("radius", options.radius, kPositive);
  static const EnumNames<RadiusConstraint> constraints{
      {RadiusConstraint::kSteeringRoom, "steering_room"},
      {RadiusConstraint::kHalfLeg, "half_leg"},
      {RadiusConstraint::kNone, "none"}};
  a.Field("constraint", options.constraint, Need::kOptional, constraints);
  a.Field("max_radius", options.max_radius, Need::kOptional, kPositive);
  static const EnumNames<WithoutRoom> without_room{{WithoutRoom::kSlowDown, "slow_down"},
                                                   {WithoutRoom::kHalfLeg, "half_leg"},
                                                   {WithoutRoom::kRefuse, "refuse"}};
  a.Field("without_room", options.without_room, Need::kOptional, without_room);
  a.Field("min_speed", options.min_speed, Need::kOptional, kPositive);
  static const EnumNames<RadiusObjective> objectives{{RadiusObjective::kLargest, "largest"},
                                                     {RadiusObjective::kLiteral, "literal"},
                                                     {RadiusObjective::kTurnLocal, "turn_local"},
                                                     {RadiusObjective::kDriven, "driven"}};
  a.Field("objective", options.objective, Need::kOptional, objectives);
  a.Section("search", options.search);
  a.Field("resimulate_each_turn", options.resimulate_each_turn, Need::kOptional);
  static const EnumNames<ReferencePoint> references{
      {ReferencePoint::kRearAxle, "rear_axle"},
      {ReferencePoint::kCentreOfGravity, "centre_of_gravity"}};
  a.Field("reference", options.reference, Need::kOptional, references);
  a.Section("weights", options.weights);
}

template <typename Archive>
void Visit(Archive&, ScheduleOptions&) {}

template <typename Archive>
void Visit(Archive& a, PreviewOptions& options) {
  a.Field("distance", options.distance, Need::kOptional, Range{.min = 0.01, .max = 1000.0});
  static const EnumNames<PreviewLaw> laws{{PreviewLaw::kLinear, "linear"},
                                          {PreviewLaw::kExactArc, "exact_arc"}};
  a.Field("law", options.law, Need::kOptional, laws);
}

template <typename Archive>
void Visit(Archive& a, ConstantSteeringOptions& options) {
  a.Field("steering", options.steering, Need::kRequired, Range{.min = -1.5, .max = 1.5});
}

template <typename Archive>
void Visit(Archive& a, SpeedControlOptions& options) {
  a.Field("acceleration", options.acceleration, Need::kOptional, kPositive);
  a.Field("deceleration", options.deceleration, Need::kOptional, kPositive);
  a.Field("gain", options.gain, Need::kOptional, kPositive);
}

template <typename Archive>
void Visit(Archive& a, DriveSpec& drive) {
  a.Field("plants", drive.plants, Need::kOptional, PlantNames());
  a.Field("timestep", drive.timestep, Need::kOptional, Range{.min = 1e-5, .max = 0.02});
  a.Field("control_period", drive.control_period, Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field("state_period", drive.state_period, Need::kOptional, Range{.min = 1e-5, .max = 1.0});
  a.Field("time_limit", drive.time_limit, Need::kOptional, Range{.max = 1e5, .above = 0.0});
}

template <typename Archive>
void Visit(Archive& a, PlantExpectation& expect) {
  a.Field("reach_goal", expect.reach_goal, kNotNegative);
  a.Field("max_cross_track", expect.max_cross_track, kNotNegative);
  a.Field("rms_cross_track", expect.rms_cross_track, kNotNegative);
  a.Field("max_heading_error", expect.max_heading_error, kNotNegative);
  a.Field("min_clearance", expect.min_clearance, kNotNegative);
  a.Field("collision", expect.collision);
}

template <typename Archive>
void Visit(Archive& a, BetweenExpectation& expect) {
  a.Field("plants", expect.plants, Need::kRequired, PlantNames());
  a.Field("position_max", expect.position_max, kNotNegative);
  a.Field("heading_max", expect.heading_max, kNotNegative);
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
    a.Section(plant.c_str(), own);
  }
}

template <typename Archive>
void Visit(Archive& a, Expectations& expect) {
  Visit(a, expect.all);
  VisitPlants(a, expect);
  a.List("between", expect.between);
}

template <typename Archive>
void Visit(Archive& a, RenderSpec& render) {
  a.Field("camera", render.camera, Need::kOptional);
  a.Pair("size", render.width, render.height, Range{.min = 64, .max = 7680});
  a.Field("fps", render.fps, Need::kOptional, Range{.min = 1.0, .max = 240.0});
}

template <typename Archive>
void Visit(Archive& a, Scenario& scenario) {
  int schema = 1;
  a.Field("schema", schema, Need::kRequired, Range{.min = 1, .max = 1});
  a.Identifier("name", scenario.name);
  a.Field("seed", scenario.seed, Need::kOptional);
  a.Section("vehicle", scenario.vehicle);
  a.Section("mission", scenario.mission, Need::kRequired);
  a.Section("world", scenario.world);
  a.Method("plan", scenario.plan, Planners(), Need::kOptional, [](auto&) {});
  std::optional<ControllerOptions> steering = scenario.control.steering;
  a.Method("control", steering, Controllers(), Need::kOptional,
           [&](auto& inner) { inner.Section("speed", scenario.control.speed); });
  scenario.control.steering = *steering;
  a.Section("drive", scenario.drive);
  a.Section("expect", scenario.expect);
  a.Section("render", scenario.render);
}

}  // namespace trackbed

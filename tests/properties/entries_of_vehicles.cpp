// Calls of the public functions of vehicles and the world.

#include <algorithm>

#include "tests/properties/entries.h"
#include "tests/properties/problems.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/single_track_car.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/vehicle/steering_schedule.h"
#include "trackbed/world/world.h"

namespace properties {

using namespace trackbed;

namespace {

World WorldWithAll() {
  World world;
  world.friction_patches = {{{{5.0, 0.0, 0.0}, 2.0, 2.0}, 0.5}};
  world.ground.bumps = {{.area = {{10.0, 0.0, 0.0}, 4.0, 4.0}}};
  world.ground.side_slopes = {{.area = {{20.0, 0.0, 0.0}, 10.0, 4.0}, .slope = 0.1}};
  world.wind.velocity = {1.0, 0.0};
  world.wind.gusts = {{.velocity = {2.0, 0.0}, .from = 1.0, .duration = 3.0}};
  world.obstacles = {{.footprint = {{30.0, 5.0, 0.3}, 2.0, 1.0}, .velocity = {0.5, 0.0}}};
  return world;
}

}  // namespace

std::vector<Entry> OfVehicles() {
  const VehicleParams car = ScaledCar(1.0);
  VehicleParams slipping = car;
  slipping.yaw_inertia = 2000.0;
  slipping.cornering_stiffness_front = slipping.cornering_stiffness_rear = 1e5;
  const auto kinematic = [car](const Command& command, double duration) {
    KinematicCar own(car, ReferencePoint::kRearAxle, {.pose = {}, .speed = 2.0});
    own.Step(command, duration);
    return SumOf(own.state().pose);
  };
  const auto single_track = [slipping](const Command& command, double duration) {
    SingleTrackCar own(slipping, {.pose = {}, .speed = 2.0});
    own.Step(command, duration);
    return SumOf(own.state().pose);
  };
  return {
      {"KinematicCar steering", [=](double x) { return kinematic({.steering = x}, 0.01); }},
      {"KinematicCar acceleration", [=](double x) { return kinematic({.acceleration = x}, 0.01); }},
      {"KinematicCar duration", [=](double x) { return kinematic({}, x > 1e6 ? 1.0 : x); }},
      {"SingleTrackCar steering", [=](double x) { return single_track({.steering = x}, 0.01); }},
      {"SingleTrackCar acceleration",
       [=](double x) { return single_track({.acceleration = x}, 0.01); }},
      {"SingleTrackCar duration", [=](double x) { return single_track({}, x > 1e6 ? 1.0 : x); }},
      {"FaultySteering", [](double x) { return FaultySteering({}, 0.01, 0.0).Pass(x); }},
      {"FaultySteering delay",
       [](double x) { return FaultySteering({.delay = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering factor",
       [](double x) { return FaultySteering({.factor = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering backlash",
       [](double x) { return FaultySteering({.backlash = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering timestep",
       [](double x) { return FaultySteering({.delay = 0.1}, x, 0.0).Pass(0.1); }},
      {"SteeringSchedule turn",
       [](double x) {
         return SteeringSchedule({{x, 10.0, 0.2}}, 0.05).At(5.0);
       }},
      {"SteeringSchedule steering",
       [](double x) {
         return SteeringSchedule({{1.0, 10.0, x}}, 0.05).At(5.0);
       }},
      {"SteeringSchedule slope",
       [](double x) {
         return SteeringSchedule({{1.0, 10.0, 0.2}}, x).At(5.0);
       }},
      {"SteeringSchedule knot",
       [](double x) {
         return SteeringSchedule::Through({{0.0, x}, {1.0, 0.0}}).At(0.5);
       }},
      {"SteeringSchedule knot distance",
       [](double x) {
         return SteeringSchedule::Through({{x, 0.1}}).At(0.5);
       }},
      {"SteeringSchedule::At",
       [](double x) {
         return SteeringSchedule::Through({{0.0, 0.1}, {1.0, 0.0}}).At(x);
       }},
      {"RollOut distance",
       [=](double x) {
         return SumOf(RollOut(car, {.pose = {}, .speed = 1.0}, {}, std::min(x, 1e3), 0.1).pose);
       }},
      {"RollOut step",
       [=](double x) {
         return SumOf(
             RollOut(car, {.pose = {}, .speed = 1.0}, {}, 5.0, x > 0.0 ? std::max(x, 1e-3) : x)
                 .pose);
       }},
      {"SteeringForCurvature", [=](double x) { return SteeringForCurvature(car, x); }},
      {"CurvatureForSteering", [=](double x) { return CurvatureForSteering(car, x); }},
      {"AckermannAngles", [=](double x) { return AckermannAngles(car, x).left; }},
      {"BicycleAngle",
       [=](double x) {
         return BicycleAngle(car, {x, 0.1});
       }},
      {"RampPose", [=](double x) { return SumOf(RampPose(car, x, 2.0)); }},
  };
}

std::vector<Entry> OfWorlds() {
  const VehicleParams car = ScaledCar(1.0);
  const auto clearance = [car](const Pose2& pose, double time) {
    return Clearance(WorldWithAll(), car, pose, time).value();
  };
  return {
      {"Clearance x",
       [=](double x) {
         return clearance({x, 0.0, 0.0}, 0.0);
       }},
      {"Clearance yaw",
       [=](double x) {
         return clearance({0.0, 0.0, x}, 0.0);
       }},
      {"Clearance time", [=](double x) { return clearance({}, x); }},
      {"Clearance length",
       [=](double x) {
         VehicleParams other = car;
         other.length = x;
         return Clearance(WorldWithAll(), other, {}, 0.0).value();
       }},
      {"Clearance obstacle",
       [=](double x) {
         World world = WorldWithAll();
         world.obstacles[0].footprint.center.x = x;
         return Clearance(world, car, {}, 0.0).value();
       }},
      {"Clearance velocity",
       [=](double x) {
         World world = WorldWithAll();
         world.obstacles[0].velocity.x() = x;
         return Clearance(world, car, {}, 1.0).value();
       }},
      {"ApproachBetween",
       [=](double x) {
         return ApproachBetween(WorldWithAll(), car, {{}, 0.0, 20.0}, {{x, 0.0, 0.0}, 1.0, 20.0})
             .clearance;
       }},
      {"GroundHeight",
       [](double x) {
         return GroundHeight(WorldWithAll(), {x, 0.0});
       }},
      {"GroundNormal",
       [](double x) {
         return GroundNormal(WorldWithAll(), {10.0, x}).sum();
       }},
      {"RoadFactor",
       [](double x) {
         return RoadFactor(WorldWithAll(), {x, 0.0});
       }},
      {"WindAt",
       [](double x) {
         return SumOf(WindAt(WorldWithAll(), {0.0, 0.0}, x));
       }},
      {"IsKnown by time",
       [=](double x) {
         const Obstacle box{.footprint = kBox, .known_from_time = 2.0, .known_from_range = {}};
         return IsKnown(box, x, kBox) ? kWell : kNone;
       }},
  };
}

}  // namespace properties

#include <chrono>

#include "src/drive/lookout.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/avoidance.h"

namespace trackbed {

CarModel LoadCar(const Scenario& scenario) {
  const auto file = FindModel(scenario.vehicle.model, scenario.folder);
  CarModel car(ComposeScene(file, {.timestep = scenario.drive.timestep,
                                   .steering_rate = scenario.vehicle.steering_rate}),
               file.string());
  if (scenario.disturb.payload) {
    car = {WithPayload(car, *scenario.disturb.payload), file.string()};
  }
  if (scenario.world.obstacles.empty() && IsFlat(scenario.world.ground)) {
    return car;
  }
  return {WithWorld(car.scene(), car.params(), scenario.world), file.string()};
}

Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle) {
  const StartState start = StartOf(scenario);
  if (!scenario.plan) {
    Plan plan;
    plan.reference.speed = SpeedProfile({{0.0, SpeedOf(scenario)}});
    plan.schedule_speed = plan.reference.speed;
    return plan;
  }
  std::vector<OrientedBox> known;
  for (const Obstacle& obstacle : scenario.world.obstacles) {
    // What moves will be elsewhere: whoever plans again on the way reckons with that.
    const bool for_later = obstacle.moves() && scenario.plan->replan;
    if (!for_later && IsKnown(obstacle, 0.0, OutlineAt(vehicle, start.pose))) {
      known.push_back(obstacle.footprint);
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  const PlanRequest request{
      .vehicle = vehicle,
      .waypoints = scenario.mission.waypoints,
      .headings = scenario.mission.headings,
      .obstacles = known,
      .wind = scenario.world.wind,
      .start = start.pose,
      .start_speed = start.speed,
      .start_steering = start.steering,
      .speed = SpeedLimitsOf(scenario),
      .seed = scenario.seed,
      .clock =
          [begin] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          },
      .friction = scenario.world.friction,
      .friction_patches = scenario.world.friction_patches,
      .infeasible = scenario.plan->infeasible};
  Plan plan = MakePlan(request, scenario.plan->global);
  if (!plan.ok() || !scenario.plan->avoid) {
    return plan;
  }
  std::erase_if(known, [&](const OrientedBox& box) {
    return !IsForAvoider(*scenario.plan, vehicle, plan.reference.path, 0.0, box);
  });
  return PlanAround({.vehicle = vehicle,
                     .plan = plan,
                     .speed = SpeedLimitsOf(scenario),
                     .obstacles = known,
                     .station = 0.0,
                     .station_speed = start.speed,
                     .car = {},
                     .seed = scenario.seed},
                    *scenario.plan->avoid);
}

}  // namespace trackbed

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "src/drive/replanning_monitor.h"
#include "src/drive/scenario_parts.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/sim/car_grip.h"

namespace trackbed {
namespace {

/// Tells of turns that are driven slower than the mission, unless the plan does already.
void NoteSlowTurns(Plan& plan, double speed) {
  const auto slowest =
      std::min_element(plan.caps.begin(), plan.caps.end(),
                       [](const SpeedCap& a, const SpeedCap& b) { return a.speed < b.speed; });
  constexpr double kNoticed = 0.99;  // of the speed
  if (plan.notes.empty() && slowest != plan.caps.end() && slowest->speed < kNoticed * speed) {
    plan.notes.push_back(fmt::format("speed reduced to {:.3g} m/s in a turn at s = {:.4g} m",
                                     slowest->speed, slowest->from));
  }
}

/// Tells of what stands on the path of a planner that does not look for obstacles.
void NoteObstacle(Plan& plan, const VehicleParams& vehicle, const std::vector<OrientedBox>& known) {
  const CollisionChecker touching(vehicle, known, 0.0);
  if (const std::optional<double> s = touching.FirstBlocked(plan.reference.path)) {
    plan.notes.push_back(fmt::format("the path hits an obstacle at s = {:.4g} m", *s));
  }
}

/// The road's factors in a world.
std::vector<double> Roads(const World& world) {
  std::vector<double> roads{world.friction};
  for (const FrictionPatch& patch : world.friction_patches) {
    if (std::find(roads.begin(), roads.end(), patch.friction) == roads.end()) {
      roads.push_back(patch.friction);
    }
  }
  return roads;
}

/// The route over the world's roads; none without them.
LaneMission MakeLaneMission(const Scenario& scenario) {
  const auto& roads = scenario.world.road_network;
  return roads && roads->data
             ? LaneMission{{roads->data, &roads->data->network}, scenario.mission.route}
             : LaneMission{};
}

/// `diagram` makes the one of the car on given roads, if the mission wants it.
template <typename Diagram>
std::optional<SpeedAtLimit> LimitsFor(const Scenario& scenario, const Diagram& diagram) {
  const auto& profile = scenario.mission.speed_profile;
  const auto* limits = profile ? std::get_if<LimitProfileOptions>(&*profile) : nullptr;
  if (limits == nullptr || !scenario.plan) {
    return std::nullopt;
  }
  return SpeedAtLimit{diagram(Roads(scenario.world)), *limits, scenario.world.ground};
}

Plan PlanWith(const Scenario& scenario, const VehicleParams& vehicle,
              std::optional<SpeedAtLimit> limits) {
  const StartState start = InitialState(scenario, vehicle);
  if (!scenario.plan) {
    Plan plan;
    plan.reference.speed = SpeedProfile({{0.0, MissionSpeed(scenario)}});
    plan.schedule_speed = plan.reference.speed;
    return plan;
  }
  std::vector<OrientedBox> known;
  for (const Obstacle& obstacle : scenario.world.obstacles) {
    // What moves will be elsewhere: whoever plans again on the way reckons with that.
    const bool for_later = obstacle.moves() && scenario.plan->replan;
    if (!for_later && IsKnown(obstacle, 0.0, FootprintAt(vehicle, start.pose))) {
      known.push_back(obstacle.footprint);
    }
  }
  const std::vector<OrientedBox>& walls = MapWalls(scenario.world);
  known.insert(known.end(), walls.begin(), walls.end());
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
      .speed = MakeSpeedLimits(scenario),
      .seed = scenario.seed,
      .clock =
          [begin] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          },
      .friction = scenario.world.friction,
      .friction_patches = scenario.world.friction_patches,
      .on_track = scenario.mission.track
                      ? TrackLaps{scenario.mission.track->data, scenario.mission.track->laps}
                      : TrackLaps{},
      .lanes = MakeLaneMission(scenario),
      .infeasible = scenario.plan->infeasible,
      .limits = std::move(limits)};
  Plan plan = MakePlan(request, scenario.plan->global);
  if (!plan.ok()) {
    return plan;
  }
  NoteSlowTurns(plan, request.speed.speed);
  if (!scenario.plan->avoid) {
    if (!scenario.plan->replan) {
      NoteObstacle(plan, vehicle, known);
    }
    return plan;
  }
  std::erase_if(known, [&](const OrientedBox& box) {
    return !IsForAvoider(MakeReplanningConfig(scenario), vehicle, plan.reference.path, 0.0, box);
  });
  return PlanAround({.vehicle = vehicle,
                     .plan = plan,
                     .speed = MakeSpeedLimits(scenario),
                     .obstacles = known,
                     .station = 0.0,
                     .station_speed = start.speed,
                     .car = {},
                     .seed = scenario.seed},
                    *scenario.plan->avoid);
}

}  // namespace

Plan PlanMission(const Scenario& scenario, const CarModel& car) {
  return PlanWith(scenario, car.unladen(),
                  LimitsFor(scenario, [&](const std::vector<double>& roads) {
                    return ComputeGgv(car, scenario.vehicle.tyre, roads);
                  }));
}

Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle) {
  return PlanWith(scenario, vehicle, LimitsFor(scenario, [&](const std::vector<double>& roads) {
                    return FrictionGgv(vehicle, roads);
                  }));
}

}  // namespace trackbed

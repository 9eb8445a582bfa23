#include "trackbed/drive/drive.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "src/drive/car_stages.h"
#include "src/drive/mission.h"
#include "src/drive/recorded_log.h"
#include "src/drive/scenario_parts.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/schedule.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/course/lane_change.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/sim/car_grip.h"

namespace trackbed {

CarModel LoadCar(const Scenario& scenario) {
  const std::filesystem::path file = FindModel(scenario.vehicle.model, scenario.folder);
  CarModel car = LoadBareCar(MakeSceneOptions(scenario), file);
  if (std::optional<Scene> towing = TowingScene(scenario, car)) {
    car = {std::move(*towing), file.string()};
  }
  if (std::optional<Scene> laden = LadenScene(scenario, car)) {
    car = {std::move(*laden), file.string()};
  }
  if (std::optional<Scene> scene = SceneInWorld(scenario, car)) {
    car = {std::move(*scene), file.string()};
  }
  return car;
}

FeasiblePlan PlanScenario(const Scenario& scenario, const CarModel& car) {
  return PlanMission(scenario, car.unladen(), [&](const std::vector<double>& roads) {
    return ComputeGgv(car, scenario.vehicle.tyre, roads);
  });
}

FeasiblePlan PlanScenario(const Scenario& scenario, const VehicleParams& vehicle) {
  return PlanMission(scenario, vehicle,
                     [&](const std::vector<double>& roads) { return FrictionGgv(vehicle, roads); });
}

LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car) {
  const DriveSpec& drive = scenario.drive;
  LoopConfig config{.vehicle = car.params(),
                    .nominal_vehicle = car.unladen(),
                    .trailer = car.trailer() ? std::optional(car.trailer()->params) : std::nullopt,
                    .world = scenario.world,
                    .timestep = drive.timestep,
                    .control_period = drive.control_period,
                    .state_period = drive.state_period,
                    .time_limit = drive.time_limit,
                    .duration = RunDuration(scenario),
                    .goal_tolerance = drive.goal_tolerance,
                    .station_source = ControllerFor(scenario.control.steering).station,
                    .follow_schedule = scenario.control.steering.Is<ScheduleOptions>(),
                    .steering_input = drive.steering,
                    .speed = scenario.control.speed,
                    .disturbances = scenario.disturb,
                    .seed = scenario.seed,
                    .configuration_columns = car.configuration_columns()};
  if (scenario.plan) {
    if (const auto* course = scenario.plan->global.GetIf<LaneChangePlannerOptions>()) {
      config.coasts_from = ReleaseStation(*course, car.params());
    }
  }
  if (!scenario.mission.headings.empty()) {
    config.goal_heading_tolerance = drive.goal_heading_tolerance;
  }
  if (scenario.plan && (scenario.plan->avoid || scenario.plan->replan)) {
    config.replanning = MakeReplanningConfig(scenario);
  }
  return config;
}

namespace {

/// Makes the plant (car model) with the given name, in the start state of the scenario.
std::unique_ptr<Plant> PlantAtStart(const Scenario& scenario, const CarModel& car,
                                    const std::string& name) {
  StartState start = InitialState(scenario, car.params());
  if (scenario.record && !scenario.mission.start.steering &&
      scenario.drive.steering == SteeringInput::kActuator) {
    start.steering = RestingSteering(car.params(), start.steering);
  }
  return MakePlant(name, {.car = car,
                          .world = scenario.world,
                          .start = start,
                          .tyre = scenario.vehicle.tyre,
                          .steering = scenario.drive.steering,
                          .aids = scenario.vehicle.aids.value_or(AidOptions{})});
}

}  // namespace

RunLog SimulateScenario(const Scenario& scenario, const CarModel& car, const FeasiblePlan& plan,
                        const std::string& plant_name, const DriveHooks& hooks) {
  if (plant_name == kRecordedPlant) {
    return RecordedLog(scenario, car);
  }
  const auto controller =
      MakeSteeringController(scenario.control.steering, scenario.control.actuator);
  const auto plant = PlantAtStart(scenario, car, plant_name);
  LoopConfig config = MakeLoopConfig(scenario, car);
  config.hooks = hooks;
  RunLog log = SimulateClosedLoop(*plant, *controller, plan, config);
  log.plant = plant_name;
  return log;
}

SteppedLoop MakeSteppedLoop(const std::shared_ptr<const Scenario>& scenario,
                            const std::shared_ptr<const CarModel>& car, const FeasiblePlan& plan,
                            const std::string& plant_name, bool keeps_log) {
  if (plant_name == kRecordedPlant) {
    throw InputError(Problem{.message = fmt::format("the plant {} is a recorded drive, which "
                                                    "cannot be stepped",
                                                    kRecordedPlant)});
  }
  auto plant = PlantAtStart(*scenario, *car, plant_name);
  return {
      std::move(plant),
      MakeSteeringController(scenario->control.steering, scenario->control.actuator),
      plan,
      MakeLoopConfig(*scenario, *car),
      std::make_shared<std::pair<std::shared_ptr<const Scenario>, std::shared_ptr<const CarModel>>>(
          scenario, car),
      keeps_log};
}

}  // namespace trackbed

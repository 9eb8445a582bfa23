#pragma once

#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The car of a scenario, compiled for its timestep. InputError when the model cannot be used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission, around the obstacles that are known at its start. Without a `plan`
/// section the plan is an empty path at the mission's speed. Reproducible except for planners with
/// a time limit: that is wall-clock time. Speeds at the limit (mission.speed_profile) are those of
/// the car's tyres, springs and drive without its payload, of all roads of the world
/// (sim/car_grip.h).
Plan PlanMission(const Scenario& scenario, const CarModel& car);

/// The same for parameters alone, with FrictionGgv for speeds at the limit.
Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// The LoopConfig of a scenario, for SimulateClosedLoop with your own plant or controller.
/// `follow_schedule` and the station source are those of the scenario's controller.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// SimulateClosedLoop with the scenario's controller and the plant of that name; of kRecordedPlant
/// the record itself. A car that replays a record starts with its steering where the recorded
/// command would bring it to rest, unless the mission says otherwise. An obstacle that
/// becomes known and blocks the path triggers a replan; the current plan is followed until the
/// delay of the local planner has passed, and the new one starts at the car's state then.
///
/// Guarantees: the same scenario, plan and build give the same log bit for bit. Errors:
/// PreconditionError for a plan that is not ok, and for kRecordedPlant without a record; InputError
/// for an unknown plant, or one that does not support the car.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const Plan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

#pragma once

#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The car of a scenario, compiled for its timestep. InputError when the model cannot be used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission around the obstacles that are known at its start. Without a `plan`
/// section, the plan is an empty path at the mission's speed. Reproducible except for planners with
/// a time limit, which is wall-clock time. Speeds at the limit (mission.speed_profile) account for
/// the car's tyres, springs and drive without its payload, and for all roads of the world
/// (sim/car_grip.h).
FeasiblePlan PlanMission(const Scenario& scenario, const CarModel& car);

/// As above, for parameters alone: speeds at the limit are those of FrictionGgv.
FeasiblePlan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// The LoopConfig of a scenario, for SimulateClosedLoop with a user-defined plant or controller.
/// `follow_schedule` and the station source are those of the scenario's controller.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// Runs SimulateClosedLoop with the scenario's controller and the named plant; kRecordedPlant
/// returns the record itself. A car that replays a record starts with the steady-state steering
/// angle of the recorded command, unless the mission sets it. An obstacle that becomes known and
/// blocks the path triggers a replan; the car follows the current plan until the delay of the local
/// planner has passed, and the new plan starts at the car's state then.
///
/// Guarantees: the same scenario, plan and build give the same log bit for bit. Errors:
/// PreconditionError for a plan that is not ok, and for kRecordedPlant without a record; InputError
/// for an unknown plant, or one that does not support the car.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const FeasiblePlan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

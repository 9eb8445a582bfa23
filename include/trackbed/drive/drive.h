#pragma once

#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Compiles the car of a scenario for the scenario's timestep. InputError if the model cannot be
/// used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission around the obstacles that are known at its start. Without a `plan`
/// section, the plan is an empty path at the mission's speed. Planning is reproducible, except for
/// planners with a time limit in wall-clock time. Speeds at the limit (mission.speed_profile)
/// account for the car's tyres, springs and drive without its payload, and for all roads of the
/// world (sim/car_grip.h).
FeasiblePlan PlanMission(const Scenario& scenario, const CarModel& car);

/// As PlanMission above, from parameters only: speeds at the limit are those of FrictionGgv.
FeasiblePlan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// The LoopConfig of a scenario, for SimulateClosedLoop with a user-defined plant or controller.
/// `follow_schedule` and the station source are those of the scenario's controller.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// Runs SimulateClosedLoop with the scenario's controller and the named plant; for kRecordedPlant,
/// returns the record itself. A car that replays a record starts with the steady-state steering
/// angle of the recorded command, unless the mission sets the angle. An obstacle that becomes known
/// and blocks the path triggers a replan. The car follows the current plan until the delay of the
/// local planner has passed; the new plan starts at the car's state at that time.
///
/// Guarantees: the same scenario, plan and build give the same log bit for bit. Errors:
/// PreconditionError for a plan that is not ok, and for kRecordedPlant without a record; InputError
/// for an unknown plant, or for a plant that does not support the car.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const FeasiblePlan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

#pragma once

#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Compiles the car of a scenario for the scenario's timestep. Throws InputError if the car model
/// cannot be used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission around the obstacles that are known at its start. Without a `plan`
/// section, the plan is an empty path at the mission's speed. Planning is reproducible, except for
/// planners with a time limit in wall-clock time. Speeds at the limit (mission.speed_profile)
/// account for the car's tyres, springs and drive without its payload, and for all roads of the
/// world (sim/car_grip.h).
FeasiblePlan PlanMission(const Scenario& scenario, const CarModel& car);

/// Plans the mission from vehicle parameters, without a car model. FrictionGgv gives the g-g-v
/// diagram for speeds at the limit.
FeasiblePlan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// Makes the LoopConfig of a scenario, for calls of SimulateClosedLoop with a user-defined plant or
/// controller. The scenario's controller determines `follow_schedule` and the station source.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// Runs SimulateClosedLoop with the scenario's controller and the named plant; for kRecordedPlant,
/// returns the scenario's recorded drive as a log. A car that replays a record starts with the
/// steady-state steering angle of the recorded command, unless the mission sets the angle. An
/// obstacle that becomes known and blocks the path triggers replanning. The car follows the current
/// plan until the delay of the local planner has passed. The new plan starts at the state that the
/// car then has.
///
/// Guarantees: the same scenario, plan and build give the same log, bit for bit. Errors: throws
/// PreconditionError for a plan that is not ok, and for kRecordedPlant without a record. Throws
/// InputError for an unknown plant, and for a plant that does not support the car.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const FeasiblePlan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

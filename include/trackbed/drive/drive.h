#pragma once

#include <memory>
#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/drive/stepped_loop.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Compiles the car model of a scenario for the scenario's timestep. Throws InputError if the car
/// model cannot be used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission around the obstacles that are known at the start of the run.
/// Without a `plan` section, the plan is an empty path at the mission's speed. Planning is
/// reproducible, except for planners with a time limit in wall-clock time. The speed profile at the
/// car's limit (mission.speed_profile) accounts for the tyres, springs and drive of the car without
/// payload, and for all friction coefficients of the world (sim/car_grip.h).
FeasiblePlan PlanScenario(const Scenario& scenario, const CarModel& car);

/// Plans the mission from vehicle parameters, without a car model. Speed profiles at the car's
/// limit use the g-g-v diagram from FrictionGgv.
FeasiblePlan PlanScenario(const Scenario& scenario, const VehicleParams& vehicle);

/// Makes the LoopConfig of a scenario, to call SimulateClosedLoop with a user-defined plant or
/// controller. The scenario's controller determines LoopConfig::follow_schedule and
/// LoopConfig::station_source.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// Runs SimulateClosedLoop with the scenario's controller and the named plant; if the name is
/// kRecordedPlant, returns the scenario's recorded drive as a log. A car that replays a recorded
/// drive starts with the steering angle that the first recorded command would produce in steady
/// state, unless the mission sets the start angle. When an obstacle becomes known and blocks the
/// path, the car replans. The car follows the current plan until the delay of the local planner has
/// passed. The new plan starts at the car's state at the end of the local planner's delay.
///
/// Guarantees: the same scenario, plan and build give the same log, bit for bit. Throws
/// PreconditionError for a plan that is not ok, and for kRecordedPlant if the scenario has no
/// recorded drive. Throws InputError for an unknown plant, and for a plant that does not support
/// the car.
RunLog SimulateScenario(const Scenario& scenario, const CarModel& car, const FeasiblePlan& plan,
                        const std::string& plant_name, const DriveHooks& hooks = {});

/// Makes the loop that SimulateScenario runs, to be stepped by the caller. The returned loop keeps
/// the scenario and the car alive. If `keeps_log` is false, the log of the loop only contains its
/// last row. Throws the same errors as SimulateScenario; for kRecordedPlant, throws InputError.
SteppedLoop MakeSteppedLoop(const std::shared_ptr<const Scenario>& scenario,
                            const std::shared_ptr<const CarModel>& car, const FeasiblePlan& plan,
                            const std::string& plant_name, bool keeps_log = true);

}  // namespace trackbed

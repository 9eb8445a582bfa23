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
/// section the plan is an empty path at the mission's speed. The same plan every time, but for
/// planners with a time limit: that is by the clock on the wall.
Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// What a scenario says of the closed loop, for SimulateClosedLoop with a plant or a controller of
/// your own. `follow_schedule` and the station source are those of the scenario's controller.
LoopConfig MakeLoopConfig(const Scenario& scenario, const CarModel& car);

/// SimulateClosedLoop with the scenario's controller and the plant of that name. An obstacle that
/// becomes known and stands in the way calls for a new plan; the old one is driven until the
/// avoider's delay has passed, and the new one starts from where the car then is.
///
/// Guarantees: the same scenario, plan and build give the same log bit for bit.
/// Errors: PreconditionError for a plan that is not ok; InputError for a plant that there is none
/// of, or that cannot be made of the car.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const Plan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

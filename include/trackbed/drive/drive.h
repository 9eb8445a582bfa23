#pragma once

#include <functional>
#include <string>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// How a caller follows a drive and ends it early. Each may be empty.
struct DriveHooks {
  std::function<void(double fraction)> progress;  ///< called at most 100 times, with 0 to 1
  std::function<bool()> interrupted;              ///< asked once per control period
  std::function<void(double seconds)> steered;    ///< told what each update of the steering took,
                                                  ///< by the clock on the wall
};

/// The car of a scenario, compiled for its timestep. InputError when the model cannot be used.
CarModel LoadCar(const Scenario& scenario);

/// Plans the scenario's mission, around the obstacles that are known at its start. Without a `plan`
/// section the plan is an empty path at the mission's speed. The same plan every time, but for
/// planners with a time limit: that is by the clock on the wall.
Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle);

/// The closed loop on one plant: every control period observe, take up a new plan if one is due,
/// project onto the path, steer, set the speed, log, and let the plant take its physics steps. An
/// obstacle that becomes known and stands in the way calls for a new plan; the old one is driven
/// until the avoider's delay has passed, and the new one starts from where the car then is. Ends at
/// rest at the end of the path, which is no arrival if the mission's plan is partial, after the
/// mission's duration, at the time limit, when the physics diverges, or when asked to.
///
/// Guarantees: the same scenario, plan and build give the same log bit for bit. A plan that is not
/// ok is an InternalError.
RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const Plan& plan,
                  const std::string& plant_name, const DriveHooks& hooks = {});

}  // namespace trackbed

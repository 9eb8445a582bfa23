#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the largest overspeed that the speed control of a run can still correct [m/s]. Returns
/// none if the plan never sets the speed.
///
/// At an overspeed e, the speed control commands the planned acceleration minus k e, where k is
/// control.speed.gain. The acceleration command is at least -D. The bound D is twice
/// control.speed.deceleration. If the car cannot brake that hard, D is the car's largest
/// deceleration at the highest friction factor of the run. At the overspeed e = D/k, the command
/// saturates. A larger overspeed means that a disturbance, such as a grade, is stronger than the
/// saturated speed control. A command is held for a control period T, in which the overspeed may
/// change by D T. The limit of the overspeed is therefore D/k + D T.
std::optional<double> OverspeedLimit(const RunLog& log, const Scenario& scenario,
                                     const VehicleParams& vehicle);

}  // namespace trackbed

#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// The largest overspeed that the speed control of a run can still correct [m/s]; none if the plan
/// never sets the speed.
///
/// The control asks for the planned acceleration less k e, e the overspeed, k control.speed.gain,
/// down to -D, D twice control.speed.deceleration or the hardest braking on the best road under the
/// car, whichever is less. At e = D/k the command saturates: whatever still makes the car faster,
/// such as a grade, is stronger than the control. A command is held for a control period T, over
/// which the overspeed may change by D T. The limit is D/k + D T.
std::optional<double> OverspeedLimit(const RunLog& log, const Scenario& scenario,
                                     const VehicleParams& vehicle);

}  // namespace trackbed

#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// The largest overspeed that a run's speed control can still correct [m/s]; none if the plan never
/// sets the speed.
///
/// For an overspeed e, the control asks for the planned acceleration less k e, where k is
/// control.speed.gain. The acceleration command is at least -D. The bound D is twice
/// control.speed.deceleration, or the hardest braking on the best road under the car if that is
/// less. At the overspeed e = D/k, the command saturates. A disturbance that accelerates the car
/// further, such as a grade, is stronger than the saturated speed control. A command is held for a
/// control period T, in which the overspeed may change by D T. The limit of the overspeed is
/// therefore D/k + D T.
std::optional<double> OverspeedLimit(const RunLog& log, const Scenario& scenario,
                                     const VehicleParams& vehicle);

}  // namespace trackbed

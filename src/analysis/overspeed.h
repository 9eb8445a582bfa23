#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the largest overspeed that the speed control of a run can still correct [m/s].
/// OverspeedLimit returns nullopt if no row of the log has a planned speed.
///
/// At an overspeed e, the speed control commands the planned acceleration minus k e, where k is
/// control.speed.gain. The largest commanded deceleration D is twice control.speed.deceleration. If
/// the car cannot brake at twice control.speed.deceleration, the deceleration D in OverspeedLimit
/// is the largest that the car reaches at the highest friction coefficient of the run. At the
/// overspeed D/k, with the gain k of the speed control, the commanded deceleration reaches its
/// maximum D. A larger overspeed means that a disturbance, such as a grade, is stronger than the
/// saturated speed control. The acceleration command is constant during a control period T, so the
/// overspeed may change by D T before the next command, with the largest deceleration D.
/// OverspeedLimit returns D/k + D T, with the largest deceleration D, the gain k and the control
/// period T.
std::optional<double> OverspeedLimit(const RunLog& log, const Scenario& scenario,
                                     const VehicleParams& vehicle);

}  // namespace trackbed

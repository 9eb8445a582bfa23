#pragma once

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Converts the record of a scenario to the log of a run. The log of the record has one row per
/// control period and ends with the mission or the record, whichever is earlier. In the log, the
/// wheels of the recorded car roll without slip; only videos show this wheel motion. The logged
/// steering angle is the measured angle, or, if no angle was measured, the steady-state angle for
/// the steering command.
RunLog RecordedLog(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed

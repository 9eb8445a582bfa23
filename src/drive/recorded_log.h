#pragma once

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Converts the record of a scenario to the log of a run. The log has one row per control period
/// and ends when the mission or the record ends, whichever is earlier. The log assumes that the
/// wheels of the recorded car roll without slip; only videos show the wheels. The logged steering
/// angle is the measured angle, or, without a measurement, the steady-state angle of the steering
/// command.
RunLog RecordedLog(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed

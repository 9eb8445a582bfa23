#pragma once

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Converts the record of a scenario to the log of a run. The log has one row per control period,
/// to the end of the mission or of the record. The wheels of the recorded car spin without slip,
/// which only films show. The logged steering angle is the measured one; without it, the
/// steady-state angle of the command.
RunLog RecordedLog(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed

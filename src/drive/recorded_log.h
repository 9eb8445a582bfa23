#pragma once

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The record of a scenario that has one, as the log of a run: one row per control period, to the
/// end of the mission or of the record. Wheels spin without slip, which only films show. The
/// steering angle is the measured one; without it, the steady-state angle of the command.
RunLog RecordedLog(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed

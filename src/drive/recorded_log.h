#pragma once

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The record of a scenario that has one, as the log of a run of that car: a row per control
/// period, to the end of the mission or of the record. Wheels roll as those of a car that does not
/// slip; that is for the film. The steering angle is the measured one, or else where the command
/// would bring it to rest.
RunLog RecordedLog(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed

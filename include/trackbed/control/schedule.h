#pragma once

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Open-loop controller: commands the steering angle of the plan's steering schedule at the
/// distance that the car will have driven by the end of the control period. A rate-limited actuator
/// then reproduces the schedule for any period.
struct ScheduleOptions {};
void Visit(KeyVisitor& keys, ScheduleOptions& options);

ControllerEntry ScheduleController();

}  // namespace trackbed

#pragma once

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Open-loop controller that follows the plan's steering schedule. The commanded steering angle is
/// the scheduled angle at the distance that the car will have driven by the end of the control
/// period. A rate-limited actuator that follows the controller's commands reproduces the schedule
/// for any length of the control period.
struct ScheduleOptions {};
void Visit(KeyVisitor& keys, ScheduleOptions& options);

ControllerEntry ScheduleController();

}  // namespace trackbed

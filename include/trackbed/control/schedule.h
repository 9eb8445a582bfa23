#pragma once

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Open loop: the plan's steering schedule at the distance the car will have driven at the end of
/// the period, so that a rate-limited actuator reproduces the schedule whatever the period is.
struct ScheduleOptions {};
void Visit(KeyVisitor& keys, ScheduleOptions& options);

ControllerEntry ScheduleController();

}  // namespace trackbed

#pragma once

#include "trackbed/drive/closed_loop.h"
#include "trackbed/scenario/scenario.h"

/// Converts a scenario into the parts of the closed loop.
namespace trackbed {

SpeedLimits MakeSpeedLimits(const Scenario& scenario);

/// Requires a scenario with a plan.
ReplanningConfig MakeReplanningConfig(const Scenario& scenario);

}  // namespace trackbed

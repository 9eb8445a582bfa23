#pragma once

#include "trackbed/drive/closed_loop.h"
#include "trackbed/scenario/scenario.h"

/// Functions that convert a scenario into the inputs of the closed loop simulation.
namespace trackbed {

SpeedLimits MakeSpeedLimits(const Scenario& scenario);

/// MakeReplanningConfig requires a scenario with a plan.
ReplanningConfig MakeReplanningConfig(const Scenario& scenario);

}  // namespace trackbed

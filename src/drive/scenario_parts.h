#pragma once

#include "trackbed/drive/closed_loop.h"
#include "trackbed/scenario/scenario.h"

/// What a scenario says, as the parts of the loop take it.
namespace trackbed {

SpeedLimits MakeSpeedLimits(const Scenario& scenario);

/// Of a scenario with a plan.
ReplanningConfig MakeReplanningConfig(const Scenario& scenario);

}  // namespace trackbed

#pragma once

#include "src/scenario/diagnostics.h"

namespace trackbed {

/// Checks the mission and the plan, and adds the problems found to `c`.
void CheckMissionAndPlan(Diagnostics& c);

}  // namespace trackbed

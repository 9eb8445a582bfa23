#pragma once

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// PreconditionError for the first argument of SimulateClosedLoop that it does not take.
void CheckLoopArguments(const Plant& plant, const Plan& plan, const LoopConfig& config);

}  // namespace trackbed

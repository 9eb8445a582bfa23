#pragma once

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Throws PreconditionError for the first invalid argument of SimulateClosedLoop.
void CheckLoopArguments(const Plant& plant, const Plan& plan, const LoopConfig& config);

}  // namespace trackbed

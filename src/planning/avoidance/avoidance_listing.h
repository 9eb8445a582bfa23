#pragma once

#include "src/planning/avoidance/avoidance_stretch.h"
#include "trackbed/planning/common/plan.h"

/// The listing's curve past an obstacle in a turn, as printed.
namespace trackbed::avoidance {

/// The curve in place of the plan's turn, from S before its arc on; none, and why, where the
/// obstacle stands in no turn between straights, where the car cannot leave the plan S before the
/// arc any more (`from` is where it can), and where the listing has no curve (TurnStatus).
ReplacementSearch FindListingCurve(const AvoidanceRequest& request,
                                   const ListingAvoidanceOptions& options, const Plan& plan,
                                   const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

#pragma once

#include "src/planning/avoidance/avoidance_stretch.h"
#include "trackbed/planning/common/plan.h"

/// The listing's curve past an obstacle in a turn, as printed (Skackauskas, dissertation, listing
/// F.2).
namespace trackbed::avoidance {

/// Replaces the plan's turn by the listing's curve, which begins S before the arc. Returns no
/// curve, with a reason, if the obstacle does not stand in a turn between two straights, if the
/// point S before the arc lies before `from`, where the car can leave the plan, or if the listing
/// itself fails (TurnStatus).
ReplacementSearch FindListingCurve(const AvoidanceRequest& request,
                                   const ListingAvoidanceOptions& options, const Plan& plan,
                                   const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

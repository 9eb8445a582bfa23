#pragma once

#include "src/planning/avoidance/avoidance_stretch.h"
#include "trackbed/planning/common/plan.h"

/// Avoids an obstacle in a turn by the curve that listing F.2 of the dissertation of Skackauskas
/// defines.
namespace trackbed::avoidance {

/// Replaces the plan's turn by the curve of listing F.2, which begins at a distance S before the
/// arc. The curve may leave the plan only at the station `from` or later. Returns a reason instead
/// of a curve if the obstacle does not stand in a turn between two straights, or if the curve would
/// start before `from`. Also returns a reason if listing F.2 itself fails (TurnStatus).
ReplacementSearch FindListingCurve(const AvoidanceRequest& request,
                                   const ListingAvoidanceOptions& options, const Plan& plan,
                                   const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

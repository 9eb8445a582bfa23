#pragma once

#include "trackbed/analysis/run.h"

/// Proposes how a car can keep a demanded clearance.
namespace trackbed {

/// Appends a note to the verdict for each plant that came nearer to an obstacle than
/// `expect.min_clearance` allows, if the planner has the key `safe_distance`. The note proposes a
/// value of the key: the bound plus the distance by which the car came nearer than the plan.
void ProposeSafeDistance(RunResult& result, const VehicleParams& vehicle);

}  // namespace trackbed

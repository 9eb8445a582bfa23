#pragma once

#include "src/sim/adapt_find.h"

namespace trackbed::adapt {

/// Adds notes on faults of the model that would falsify a run: a base that cannot move freely,
/// tyres that touch the vehicle at rest, and equality constraints between joints of the steering.
void NoteFaults(const FoundModel& found, const FoundVehicle& vehicle, Findings& findings);

}  // namespace trackbed::adapt

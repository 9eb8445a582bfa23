#pragma once

#include "src/scenario/diagnostics.h"

namespace trackbed {

/// Checks the waypoints and headings of the mission together with the properties of the planner,
/// and adds the problems found to `c`.
void CheckWaypoints(Diagnostics& c);

}  // namespace trackbed

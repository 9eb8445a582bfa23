#pragma once

#include "trackbed/planning/common/planner.h"

/// Plans laps along the surveyed center line of a track (PlanRequest::on_track) by FollowLine.
namespace trackbed {

struct CenterLineOptions {};
void Visit(KeyVisitor& keys, CenterLineOptions& options);

/// Returns the planner `center_line`.
PlannerEntry CenterLinePlanner();

}  // namespace trackbed

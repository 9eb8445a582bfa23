#pragma once

#include "trackbed/planning/common/planner.h"

/// Laps along the surveyed middle of a track (PlanRequest::on_track), planned by FollowLine.
namespace trackbed {

struct CenterLineOptions {};
void Visit(KeyVisitor& keys, CenterLineOptions& options);

/// The planner `center_line`.
PlannerEntry CenterLinePlanner();

}  // namespace trackbed

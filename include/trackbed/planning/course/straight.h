#pragma once

#include "trackbed/planning/common/planner.h"

/// Plans a straight line, for tests of acceleration and braking.
namespace trackbed {

struct StraightOptions {
  double length = 50.0;  ///< Length [m], > 0 and at most kMaxPathLength.
};
void Visit(KeyVisitor& keys, StraightOptions& options);

/// Returns the planner `straight`, which plans a line from the start pose along its heading. The
/// car drives at the mission's speed and stops at the end of the line. If the line is too short to
/// reach the mission's speed, the car reaches a lower speed. The planner ignores obstacles.
PlannerEntry StraightPlanner();

}  // namespace trackbed

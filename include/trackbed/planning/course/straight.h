#pragma once

#include "trackbed/planning/common/planner.h"

/// Plans a straight line, for testing acceleration and braking.
namespace trackbed {

struct StraightOptions {
  double length = 50.0;  ///< Length of the line [m], > 0 and at most kMaxPathLength.
};
void Visit(KeyVisitor& keys, StraightOptions& options);

/// Returns the planner `straight`, which plans a straight line that begins at the car's start pose.
/// The car drives at the mission's speed and stops at the end of the line. If the line is too short
/// to reach the mission's speed, the car only reaches a lower speed. The planner `straight` ignores
/// obstacles.
PlannerEntry StraightPlanner();

}  // namespace trackbed

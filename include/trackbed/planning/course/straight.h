#pragma once

#include "trackbed/planning/common/planner.h"

/// A straight line, for tests of acceleration and braking.
namespace trackbed {

struct StraightOptions {
  double length = 50.0;  ///< Length [m], > 0 and at most kMaxPathLength.
};
void Visit(KeyVisitor& keys, StraightOptions& options);

/// The planner `straight`: a line from the start along its heading, with the mission's speed and a
/// stop at its end. If the length is too short to reach that speed, the profile peaks below it. The
/// planner ignores obstacles.
PlannerEntry StraightPlanner();

}  // namespace trackbed

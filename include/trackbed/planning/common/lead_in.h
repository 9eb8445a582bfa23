#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// The first meters of a plan for a car that rolls.
namespace trackbed {

/// A way that a rolling car can drive whatever its wheels' angle is: straight on, once they are
/// straight.
struct LeadIn {
  std::vector<Segment> segments;  ///< from the car's start; none for one that stands
  Pose2 end;                      ///< where they lead
  double length = 0.0;            ///< [m]
};

/// The wheels turn straight at the start speed; then the car goes on straight for as long as it
/// takes to slow down comfortably to `speed` [m/s] and for another `beyond` [m].
LeadIn ComputeLeadIn(const PlanRequest& request, double speed, double beyond);

}  // namespace trackbed

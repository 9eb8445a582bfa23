#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// The first meters of a plan for a car that is already rolling.
namespace trackbed {

/// A path that a rolling car can drive from any steering angle: the car straightens its wheels,
/// then continues straight.
struct LeadIn {
  std::vector<Segment> segments;  ///< Segments from the car's start; empty for a car at rest.
  Pose2 end;                      ///< Pose at the end of the segments.
  double length = 0.0;            ///< Length of the segments [m].
};

/// Computes the lead-in for the car of a request. The car straightens its wheels at the start
/// speed. Then the car continues straight while it slows down to `speed` [m/s] with the
/// deceleration of the request, and for another `beyond` [m].
LeadIn ComputeLeadIn(const PlanRequest& request, double speed, double beyond);

}  // namespace trackbed

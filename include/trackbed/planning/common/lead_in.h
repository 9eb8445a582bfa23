#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// Computes the first meters of a plan for a car that is already rolling.
namespace trackbed {

/// A start of a path that a rolling car can drive with any initial steering angle: the car
/// straightens its wheels, then continues straight.
struct LeadIn {
  /// Segments of the lead-in, from the car's start on; empty for a car at rest.
  std::vector<Segment> segments;
  Pose2 end;            ///< Pose of the car at the end of the lead-in.
  double length = 0.0;  ///< Length of the lead-in [m].
};

/// Computes the lead-in, the first meters of a plan, for the car of a request. On the lead-in, the
/// car first straightens its wheels at the start speed. After straightening its wheels, the car
/// continues straight, slows down to `speed` [m/s] with the deceleration of the request, or less
/// where the road is slippery, and drives another `beyond` [m].
LeadIn ComputeLeadIn(const PlanRequest& request, double speed, double beyond);

/// Returns polylines that leave the start in the direction of the car's heading, the shortest
/// first. The first leg of each polyline is long enough for a rolling car to stop. Some of these
/// departure polylines also make one or two quarter turns, because the first waypoint may be behind
/// the car. Each turn of a polyline has room for the car's smallest turning radius.
std::vector<std::vector<Vec2>> DeparturePolylines(const PlanRequest& request);

}  // namespace trackbed

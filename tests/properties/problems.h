#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// What a planner is asked.
struct Problem {
  trackbed::PlanRequest request;
  trackbed::PlannerOptions options;
};

/// How wild a random problem is.
struct Wildness {
  /// Coincident points, reversing and nearly parallel legs, obstacles on start and goal, and a
  /// start that has nothing to do with the route; else what a car can mostly drive.
  bool adversarial = true;
  int smallest = -6;  ///< scale of the scene, a power of ten [m]
  int largest = 2;
};

/// The reference car, all its lengths times `scale`.
trackbed::VehicleParams ScaledCar(double scale);

/// A random problem for a planner; call it within a property.
Problem AnyProblem(const trackbed::PlannerEntry& entry, const Wildness& wildness);

/// The problem in a world that is mirrored at the x axis, or moved by a pose.
Problem Mirrored(const Problem& problem);
Problem Moved(const Problem& problem, const trackbed::Pose2& by);

std::string ToText(const Problem& problem);

}  // namespace properties

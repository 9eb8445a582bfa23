#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// A planning problem: request and options.
struct Problem {
  trackbed::PlanRequest request;
  trackbed::PlannerOptions options;
};

/// Range of the random problems.
struct Wildness {
  /// Coincident points, reversing and nearly parallel legs, obstacles on start and goal, and a
  /// start unrelated to the route; otherwise mostly drivable problems.
  bool adversarial = true;
  int smallest = -6;  ///< scale of the scene, a power of ten [m]
  int largest = 2;
};

/// The reference car with all lengths multiplied by `scale`.
trackbed::VehicleParams ScaledCar(double scale);

/// A random problem for a planner; to be called within a property.
Problem AnyProblem(const trackbed::PlannerEntry& entry, const Wildness& wildness);

/// The problem mirrored at the x axis, or moved by a pose.
Problem Mirrored(const Problem& problem);
Problem Moved(const Problem& problem, const trackbed::Pose2& by);

std::string ToText(const Problem& problem);

}  // namespace properties

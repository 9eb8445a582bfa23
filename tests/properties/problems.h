#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// A planning problem: a request and the planner's options.
struct Problem {
  trackbed::PlanRequest request;
  trackbed::PlannerOptions options;
};

/// The range of the random problems.
struct Wildness {
  /// Whether problems may have coincident points, reversing or nearly parallel legs, obstacles on
  /// the start and the goal, or a start unrelated to the route. If false, most problems are
  /// drivable.
  bool adversarial = true;
  int smallest = -6;  ///< Exponent of the smallest scale of a scene, as a power of ten [m].
  int largest = 2;
};

/// Returns the reference car with all its lengths multiplied by `scale`.
trackbed::VehicleParams ScaledCar(double scale);

/// Returns a random problem for a planner. Must be called within a property.
Problem AnyProblem(const trackbed::PlannerEntry& entry, const Wildness& wildness);

/// Return the problem mirrored at the x axis, and the problem moved by a pose.
Problem Mirrored(const Problem& problem);
Problem Moved(const Problem& problem, const trackbed::Pose2& by);

std::string ToText(const Problem& problem);

}  // namespace properties

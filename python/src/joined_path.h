#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed::python {

/// Lets a path that begins at the position of the start also begin with the start's heading and, if
/// the car rolls, with the curvature of its steering angle. The result leaves `path` to the side by
/// a polynomial of degree 5 over the station. The polynomial covers the longest piece on which the
/// distance is at most `max_deviation` [m] and which has no cusp. Returns `path` unchanged if it
/// begins in reverse, or if the piece would need a larger curvature than the car can steer.
Path JoinedToStart(const Path& path, const PlanRequest& request, double max_deviation);

}  // namespace trackbed::python

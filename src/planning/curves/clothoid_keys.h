#pragma once

#include "trackbed/planning/curves/curve_planners.h"

namespace trackbed {

// Scenario keys of the planners of curves of continuous curvature.

inline constexpr Key kCurvatureKey{
    "curvature", "",
    "change of curvature between straights and arcs: along clothoids that the steering can follow "
    "(continuous; cusp_steps: except at cusps), in steps, at which the car slows down or stops, or "
    "along clothoids where they fit and in steps otherwise (auto)"};

/// Returns the names of all values of CurveCurvature, for planners whose paths have cusps.
const EnumNames<CurveCurvature>& CurvaturesWithCusps();

/// Visits the keys of the limits on paths of continuous curvature.
void VisitClothoids(KeyVisitor& keys, double& max_lateral_acceleration,
                    double& max_steering_rate_fraction);

}  // namespace trackbed

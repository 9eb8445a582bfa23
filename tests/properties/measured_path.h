#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// Why a plan that reports success is wrong, measured only from positions along its path (not from
/// the path's own curvatures); empty if it is right.
///
/// Positions are rounded by e = 16 eps (largest coordinate + length), eps = 2.2e-16: 3.5e-9 m at
/// 1000 km. Over chords of h, a hundredth of the smallest turning radius, that gives a heading
/// error of 4 e/h. If it exceeds a tenth of a radian (a car of 5 mm at 1000 km), headings and
/// curvatures are not checked.
std::string FlawIn(const trackbed::Plan& plan, const trackbed::PlanRequest& request,
                   const trackbed::PlannerEntry& entry);

}  // namespace properties

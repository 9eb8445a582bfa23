#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// What is wrong with a plan that says it is ok, measured from positions along its path alone (not
/// from the path's own curvatures); empty if nothing is.
///
/// Positions are rounded by e = 16 eps (largest coordinate + length), eps = 2.2e-16: 3.5e-9 m at
/// 1000 km. Over chords of h, a hundredth of the smallest turning radius, that is 4 e/h of a
/// heading. Where it is more than a tenth of a radian (a car of 5 mm at 1000 km), headings and
/// curvatures are not looked at.
std::string FlawIn(const trackbed::Plan& plan, const trackbed::PlanRequest& request,
                   const trackbed::PlannerEntry& entry);

}  // namespace properties

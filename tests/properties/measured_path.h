#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

namespace properties {

/// Returns why a plan that reports success is wrong; empty if the plan is correct. The check uses
/// only positions along the path, not the curvatures that the path reports.
/// Positions have a rounding error of e = 16 eps (largest coordinate + length), with eps = 2.2e-16.
/// At coordinates of 1000 km, e is 3.5e-9 m. The test measures headings from chords whose length h
/// is a hundredth of the smallest turning radius, so a heading has an error of 4 e/h. If this error
/// exceeds 0.1 rad, as for a car of 5 mm at 1000 km, the test does not check headings and
/// curvatures.
std::string FlawIn(const trackbed::Plan& plan, const trackbed::PlanRequest& request,
                   const trackbed::PlannerEntry& entry);

}  // namespace properties

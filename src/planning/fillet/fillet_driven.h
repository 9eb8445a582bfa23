#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/planning/fillet/fillet_layout.h"
#include "src/planning/fillet/fillet_radius.h"

namespace trackbed::fillet {

/// Number of variables per turn in the joint search. The variables of turn k are the radius [m],
/// the shift of the start of steering D_{2k-1}, and the change of the hold length D_2k - D_{2k-1}.
/// The two steering variables (shift and change of hold length) are fractions of the ramp length.
inline constexpr std::size_t kDrivenVariables = 3;

/// Optimizes all variables of all turns jointly for the objective kDriven, starting at a plan with
/// the largest radii.
FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start);

}  // namespace trackbed::fillet

#pragma once

#include <cstdint>
#include <vector>

#include "src/planning/fillet/fillet_layout.h"
#include "src/planning/fillet/fillet_radius.h"

namespace trackbed::fillet {

/// Optimizes the radii of all turns in two passes, for the objectives kLiteral and kTurnLocal.
/// Stores the radii and the results of the search in the plan.
void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns);

}  // namespace trackbed::fillet

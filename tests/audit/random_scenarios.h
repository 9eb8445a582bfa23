#pragma once

#include <cstddef>

#include "trackbed/scenario/scenario.h"

namespace audit {

/// Number of scenarios after which the combinations of planner, controller and plant repeat.
std::size_t Combinations();

/// Returns the scenario with a given index. The same index always gives the same scenario.
/// Successive indices combine every audited planner with every path-following controller and every
/// plant of a steered car. All other settings are random. If the program rejects a scenario as
/// invalid, a larger `attempt` gives the index another random scenario.
trackbed::Scenario RandomScenario(std::size_t index, int attempt);

}  // namespace audit

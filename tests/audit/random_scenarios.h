#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/scenario/scenario.h"

namespace audit {

/// All planners except those that need a road network or a track.
std::vector<trackbed::PlannerEntry> AuditedPlanners();

/// Number of scenarios after which the combinations of planner, controller and plant repeat.
std::size_t Combinations();

/// The scenario of an index, always the same one. Increasing indices cover every audited planner
/// with every path-following controller on every plant of a steered car; the rest is random.
/// `attempt` varies the random part if the program rejects the first one.
trackbed::Scenario RandomScenario(std::size_t index, int attempt);

}  // namespace audit

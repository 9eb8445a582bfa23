#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/scenario/scenario.h"

namespace audit {

/// Every planner but those that need a road network.
std::vector<trackbed::PlannerEntry> AuditedPlanners();

/// How many scenarios there are before planners, controllers and plants come together again as
/// they were.
std::size_t Combinations();

/// The scenario of an index: always the same one. Index by index it goes through every audited
/// planner with every controller that follows a plan on every plant, a car with steered wheels in
/// each; all else is random. `attempt` gives another one for the same three, where the first is
/// refused.
trackbed::Scenario RandomScenario(std::size_t index, int attempt);

}  // namespace audit

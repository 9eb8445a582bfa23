#pragma once

#include <cstddef>

#include "trackbed/scenario/scenario.h"

namespace audit {

/// How many scenarios there are before planners, controllers and plants come together again as
/// they were.
std::size_t Combinations();

/// The scenario of an index: always the same one. Index by index it goes through every planner with
/// every controller that follows a plan on every plant, a car with steered wheels in each; all else
/// is random. `attempt` gives another one for the same three, where the first is refused.
trackbed::Scenario RandomScenario(std::size_t index, int attempt);

}  // namespace audit

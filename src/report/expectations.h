#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// What a run was expected to keep, and what it did: an entry for every bound and every plant that
/// it is asked of, {of, what, unit, asked, found, met}. `metrics` is the run's metrics.json. The
/// verdict itself is the run's own, not made again here.
nlohmann::ordered_json ExpectationRows(const Expectations& expect,
                                       const nlohmann::ordered_json& metrics);

}  // namespace trackbed

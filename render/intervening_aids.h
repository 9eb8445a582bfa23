#pragma once

#include <optional>
#include <string>

#include "render/timed_table.h"

namespace trackbed::render {

/// Returns the names of the driver aids that intervene at a place of a run's log, such as "ABS
/// ESC". Returns "-" if no driver aid intervenes, and nullopt if the car has neither anti-lock
/// brakes nor stability control.
std::optional<std::string> InterveningAids(const TimedTable& log, const TimedTable::Place& place);

}  // namespace trackbed::render

#pragma once

#include <ostream>

#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// Prints a planner's name in GoogleTest messages.
inline void PrintTo(const PlannerEntry& entry, std::ostream* out) {
  *out << entry.name;
}

}  // namespace trackbed

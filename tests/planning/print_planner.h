#pragma once

#include <ostream>

#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// What GoogleTest prints of a planner.
inline void PrintTo(const PlannerEntry& entry, std::ostream* out) {
  *out << entry.name;
}

}  // namespace trackbed

#pragma once

#include <vector>

#include "trackbed/planning/registry/planners.h"

namespace trackbed {

/// Returns all planners except those that need a road network or a track.
inline std::vector<PlannerEntry> WaypointPlanners() {
  std::vector<PlannerEntry> entries = Planners();
  std::erase_if(entries, [](const PlannerEntry& entry) {
    return entry.follows_lanes || entry.follows_track;
  });
  return entries;
}

}  // namespace trackbed

#include "trackbed/analysis/road_look.h"

#include <algorithm>

#include "trackbed/planning/registry/planners.h"

namespace trackbed {

std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner) {
  if (world.road) {
    return world.road->width > 0.0 ? world.road : std::nullopt;
  }
  if (world.road_network) {
    return std::nullopt;
  }
  const auto follows_road = [&](const PlannerEntry& entry) {
    return entry.name == planner && !entry.keeps_clear && !entry.has_headings;
  };
  const bool follows = std::any_of(Planners().begin(), Planners().end(), follows_road);
  return follows ? std::optional(RoadLook{}) : std::nullopt;
}

}  // namespace trackbed

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/scenario/scenario.h"

namespace audit {

/// A mission that a person could draw, on an open plane without obstacles.
struct OrdinaryRoute {
  std::string shape;  ///< Kind of the route's shape, such as "hairpin".
  trackbed::Scenario scenario;
};

/// Settings of all routes of a campaign.
struct RouteSettings {
  /// Whether some routes lie at coordinates of 1e6 m, as in UTM.
  bool far_away = false;
  /// Whether the routes are short enough to be driven: at most 150 m at 1 m/s or more.
  bool driven = false;
};

/// The planners that plan through the waypoints of a mission.
std::vector<trackbed::PlannerEntry> RoutePlanners();

/// Number of different shapes of routes.
std::size_t RouteShapes();

/// Returns the route of an index, always the same one. The index selects planner and shape in turn;
/// the rest is random: lengths, angles, rounding, headings, start, speed, ice and grade.
OrdinaryRoute RouteOf(std::size_t index, const RouteSettings& settings = {});

}  // namespace audit

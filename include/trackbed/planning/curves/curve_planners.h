#pragma once

#include <optional>

#include "trackbed/planning/common/planner.h"

/// The planners whose paths are the shortest curves between poses.
namespace trackbed {

/// The shortest curves between the stops of a route, of Dubins (dubins.h).
struct DubinsOptions {
  std::optional<double> radius;  ///< of every arc [m]; none: a tenth more than the car's smallest
  double safe_distance = 0.3;    ///< of the outline from obstacles [m], >= 0
  double min_speed = 0.3;        ///< no step of curvature is taken more slowly [m/s]
};
void Visit(KeyVisitor& keys, DubinsOptions& options);

/// And of Reeds and Shepp (reeds_shepp.h).
struct ReedsSheppOptions {
  std::optional<double> radius;
  double safe_distance = 0.3;
  double min_speed = 0.3;
};
void Visit(KeyVisitor& keys, ReedsSheppOptions& options);

PlannerEntry DubinsPlanner();
PlannerEntry ReedsSheppPlanner();

}  // namespace trackbed

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/planner.h"

/// The planners whose paths are the shortest curves between poses.
namespace trackbed {

/// The shortest curves between the stops of a route, of Dubins (dubins.h).
struct DubinsOptions {
  std::optional<double> radius;  ///< of every arc [m]; none: a tenth more than the car's smallest
  double safe_distance = 0.3;    ///< of the footprint from obstacles [m], >= 0
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

/// The curve from one stop to the next.
struct CurveFindings {
  std::string word;                         ///< such as "LSR"
  double length = 0.0;                      ///< [m]
  double radius = 0.0;                      ///< of its arcs [m]
  std::ptrdiff_t shorter_ones_blocked = 0;  ///< by obstacles, or by how the car rolls
};
void Visit(DiagnosticsVisitor& out, const CurveFindings& own);

/// Of both planners.
struct CurveDiagnostics {
  std::vector<CurveFindings> curves;
};
void Visit(DiagnosticsVisitor& out, const CurveDiagnostics& own);

PlannerEntry DubinsPlanner();
PlannerEntry ReedsSheppPlanner();

}  // namespace trackbed

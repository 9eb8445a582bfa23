#pragma once

#include <optional>
#include <string>

#include "src/planning/avoidance/avoidance_curve.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"

/// From an obstacle that stands in the way to the stretch of the plan that a curve replaces.
namespace trackbed::avoidance {

/// Between the points at which a path is held against obstacles [m].
inline constexpr double kLook = 0.1;

/// A stretch of the plan on which an obstacle is too close.
struct Conflict {
  double from = 0.0;  ///< station [m]
  double to = 0.0;    ///< station [m]
  OrientedBox obstacle;
};

/// The first one beyond `from` on which an obstacle is closer than SD.
std::optional<Conflict> FirstConflict(const AvoidanceRequest& request,
                                      const BezierAvoidanceOptions& options, const Path& path,
                                      double from);

/// A curve that can be driven in place of the plan between two stations.
struct Stretch {
  CurveProblem problem;
  Repair repair;
  Ring ring = Ring::kInner;
  double leave = 0.0;  ///< station [m]
  double back = 0.0;   ///< station [m]
  RrtStarResult tree;
  OrientedBox obstacle;
  double beside = 0.0;  ///< station at which the plan runs beside the obstacle [m]
  int tried = 0;        ///< curves
};

struct StretchSearch {
  std::optional<Stretch> stretch;
  std::string why;  ///< there is none, for people
};

/// Looks for the stretch, first on the ring that RRT* prefers, at full speed, back on the plan as
/// early as can be; then on the other ring, then more slowly. `from` is where the plan, which may
/// have been led around other obstacles already, can be left.
StretchSearch FindStretch(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                          const Plan& plan, const Conflict& conflict, double from);

}  // namespace trackbed::avoidance

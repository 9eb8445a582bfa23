#pragma once

#include <optional>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

/// Properties of a planned path before it is driven: the usual measures for comparing planners.
namespace trackbed {

/// A successful plan, with the world and vehicle for which it was made.
struct PlannedPath {
  const Plan& plan;
  const World& world;
  const VehicleParams& vehicle;
};

/// A property of a path, which is written to plan.json. Studies have the output `plan.NAME`.
struct PathProperty {
  const char* name;   ///< Name with the unit: "curvature_max_radpm".
  const char* label;  ///< Label in a report.
  const char* unit;   ///< SI unit.
  /// Measures the property; nullopt if the path has no such value.
  std::optional<double> (*measure)(const PlannedPath& path);
};

/// All properties, in the order of plan.json. Symbols: kappa curvature, s station, L length of the
/// path.
///   length_m                  L
///   duration_s                driving time at the plan's speeds, without standing times
///   curvature_max_radpm       max |kappa|
///   curvature_rms_radpm       sqrt(integral of kappa^2 ds / L)
///   turning_rad               integral of |kappa| ds: total angle by which the car turns
///   curvature_rate_max_radpm2 max |dkappa/ds|, except at jumps of kappa
///   curvature_jump_max_radpm  largest jump of kappa between segments, except at cusps and stops,
///                             where a car turns its wheels at rest. Jumps of at most 1e-12 rad/m
///                             are rounding errors and count as 0
///   clearance_min_m           smallest distance of the footprint from static obstacles that are
///                             known from the start, overestimated by at most 1 cm; 0 if the
///                             footprint touches an obstacle, nullopt without such obstacles
///
/// All properties except clearance_min_m are exact to rounding, and 0 for a path of length 0. Cost:
/// a few us per segment, and one call of Clearance() per step along the path. The length of a step
/// is about the current clearance minus the smallest one so far, plus 1 cm.
const std::vector<PathProperty>& PathProperties();

}  // namespace trackbed

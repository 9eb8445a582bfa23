#pragma once

#include <optional>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

/// Properties of a planned path before it is driven: the usual measures for comparing planners.
namespace trackbed {

/// A successful plan, with its world and vehicle.
struct PlannedPath {
  const Plan& plan;
  const World& world;
  const VehicleParams& vehicle;
};

/// A property of a path. Plan.json contains it, and studies have the output `plan.NAME`.
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
///   duration_s                time of the plan's speeds, without its stops
///   curvature_max_radpm       max |kappa|
///   curvature_rms_radpm       sqrt(integral of kappa^2 ds / L)
///   turning_rad               integral of |kappa| ds: how far the car turns in all
///   curvature_rate_max_radpm2 max |dkappa/ds| between jumps
///   curvature_jump_max_radpm  largest jump of kappa between segments, cusps and stops left out: a
///                             car turns its wheels there at rest. Jumps of at most 1e-12 rad/m,
///                             which are rounding, count as 0, so that paths rank equally
///   clearance_min_m           smallest distance of the footprint from obstacles that stand still
///                             and are known from the start, at most 1 cm too large, and 0 if one
///                             is touched; nothing without such obstacles
///
/// The properties other than clearance_min_m are exact, to rounding. For a path of length 0, these
/// properties are 0. Cost: a few us per segment, and one Clearance() per (c - c_min) or 1 cm of
/// path.
const std::vector<PathProperty>& PathProperties();

}  // namespace trackbed

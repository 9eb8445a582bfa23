#pragma once

#include <optional>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

/// Properties of a planned path that are known before the drive, as commonly used to compare
/// planners.
namespace trackbed {

/// A successful plan, with the world and vehicle for which it was made.
struct PlannedPath {
  const Plan& plan;
  const World& world;
  const VehicleParams& vehicle;
};

/// A property of a planned path, which is written to plan.json. In studies, the path property NAME
/// is the output `plan.NAME`.
struct PathProperty {
  const char* name;   ///< Name of the property with its unit, such as "curvature_max_radpm".
  const char* label;  ///< Label of the property in a report.
  const char* unit;   ///< SI unit.
  /// Computes the property; returns nullopt if the property is undefined for the path.
  std::optional<double> (*measure)(const PlannedPath& path);
};

/// Returns all path properties, in the order of plan.json. Symbols: kappa curvature, s station, L
/// length of the path.
///   Property length_m: length L of the path.
///   Property duration_s: driving time at the plan's speeds, without standing times.
///   Property curvature_max_radpm: maximum of |kappa|.
///   Property curvature_rms_radpm: sqrt(integral of kappa^2 ds / L) over the path's length L.
///   Property turning_rad: integral of |kappa| ds, the total angle by which the car turns.
///   Property curvature_rate_max_radpm2: maximum of |dkappa/ds|, except at jumps of kappa.
///   Property curvature_jump_max_radpm: largest jump of kappa between segments, except at cusps and
///   stops, where a car turns its wheels at rest. Jumps of the curvature of at most 1e-12 rad/m are
///   rounding errors and count as 0.
///   Property clearance_min_m: smallest distance of the footprint from static obstacles that are
///   known from the start, overestimated by at most 1 cm. The property clearance_min_m is 0 if the
///   footprint touches an obstacle, and nullopt if no static obstacle is known from the start.
///   Property waypoint_miss_max_m: largest distance of the path from a waypoint (waypoint_miss.h);
///   nullopt if the mission has no waypoints.
///
/// All properties except clearance_min_m are exact apart from rounding errors, and are 0 for a path
/// of length 0. Cost: a few us per path segment, plus one call of Clearance() per step of the
/// clearance measurement along the path. The length of a step of the clearance measurement is about
/// 1 cm plus the difference between the current clearance and the smallest clearance so far.
const std::vector<PathProperty>& PathProperties();

}  // namespace trackbed

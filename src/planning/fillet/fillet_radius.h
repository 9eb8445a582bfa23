#pragma once

#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/fillet/steering_room.h"

namespace trackbed::fillet {

/// Interval of the permitted radii of a turn, and the constraints that determine the ends of this
/// interval.
struct RadiusLimits {
  RadiusInterval radii;
  ActiveConstraint at_low;
  ActiveConstraint at_high;
  RadiusConstraint constraint;  ///< kind of the constraint that limits the turn's radius
};

/// Throws a Refusal if the arcs of the smallest radius miss a waypoint by more than
/// FilletOptions::max_waypoint_miss. The Refusal names the largest miss, so a bound of this size is
/// sufficient for all turns. If a turn is refused for every bound, throws that turn's Refusal.
void CheckMisses(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                 const std::vector<FilletTurn>& turns);

/// Sets the speed of a turn and returns the limits of its radius. If the speed of the turn is below
/// `speed`, also stores a note with the reason. CheckMisses must have accepted the turn.
RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn);

/// Returns the constraint that limits the radius if the radius lies on a limit (relative tolerance
/// 1e-3), or kNone if the radius lies inside the limits.
ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius);

/// Returns the function g(r) [m] of the constraint g(r) <= 0, which is equation C.34 or C.40.
double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius);

}  // namespace trackbed::fillet

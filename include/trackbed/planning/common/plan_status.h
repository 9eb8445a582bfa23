#pragma once

namespace trackbed {

/// How planning ended.
enum class PlanStatus {
  kOk,
  kTooFewWaypoints,     ///< The route has fewer than three waypoints.
  kDuplicateWaypoints,  ///< A leg has zero length.
  kUTurn,               ///< Two legs point in opposite directions, so that no fillet can join them.
  kTurnTooTight,  ///< The turn is tighter than the car can steer, or no radius fits on the legs.
  /// No radius leaves enough distance on the legs for turning the wheels (eq. (C.40)).
  kNoRoomForSteering,
  kTurnsOverlap,  ///< The arcs of the given radii need more than the length of a leg.
  kSearchFailed,  ///< The search found no point that meets the constraints.
  /// The wheels would have to start turning before the route begins (D_1 < 0).
  kSteersBeforeStart,
  /// At the start, the car is too near to an obstacle, or the Frenet frame is undefined.
  kStartBlocked,
  kGoalBlocked,   ///< An obstacle is too near to the goal or a waypoint.
  kNoPath,        ///< No path exists, or no path of the required kind.
  kBudgetUsedUp,  ///< The search ended before it reached the goal.
  kCollides,      ///< The drivable path comes too near to an obstacle.
  kInfeasible,    ///< The plan exceeds the car's limits; see feasibility.h.
};

/// Returns the spelling of a status in plan.json: "ok", "too_few_waypoints", ….
const char* ToString(PlanStatus status);

}  // namespace trackbed

#pragma once

namespace trackbed {

/// How planning ended.
enum class PlanStatus {
  kOk,
  kTooFewWaypoints,     ///< The route has fewer than three waypoints.
  kDuplicateWaypoints,  ///< A leg has zero length.
  kUTurn,               ///< A leg turns back on itself, so that no fillet can join it.
  kTurnTooTight,        ///< The turn is tighter than the car can steer, or no radius fits (C.34).
  /// No radius meets C.40: the legs leave no distance for turning the wheels.
  kNoRoomForSteering,
  kTurnsOverlap,  ///< Given radii need more of a leg than its length.
  kSearchFailed,  ///< The search found no point that meets the constraints.
  /// The wheels would have to start turning before the route begins (D_1 < 0).
  kSteersBeforeStart,
  kStartBlocked,  ///< The car is too near to an obstacle, or has no frame at the start.
  kGoalBlocked,   ///< An obstacle is too near to the goal or a waypoint.
  kNoPath,        ///< No path exists, or none of the required kind.
  kBudgetUsedUp,  ///< The search ended before it reached the goal.
  kCollides,      ///< The drivable path comes too near to an obstacle.
  kInfeasible,    ///< The plan exceeds the car's limits; see feasibility.h.
};

/// The spelling of a status in plan.json: "ok", "too_few_waypoints", ….
const char* ToString(PlanStatus status);

}  // namespace trackbed

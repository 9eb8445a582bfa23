#pragma once

namespace trackbed {

/// How planning ended.
enum class PlanStatus {
  kOk,
  kTooFewWaypoints,     ///< a route needs at least three
  kDuplicateWaypoints,  ///< a leg of zero length
  kUTurn,               ///< a leg turns back on itself: no fillet joins it
  kTurnTooTight,        ///< tighter than the car can steer, or no radius fits (C.34)
  kNoRoomForSteering,   ///< C.40 has no radius: the legs leave no distance for turning the wheels
  kTurnsOverlap,        ///< given radii need more of a leg than it has
  kSearchFailed,        ///< the search found no point that meets the constraints
  /// The wheels would have to start turning before the route begins (D_1 < 0).
  kSteersBeforeStart,
  kStartBlocked,  ///< the car is too near to an obstacle, or has no frame there
  kGoalBlocked,   ///< an obstacle is too near to the goal or a waypoint
  kNoPath,        ///< no path exists, or none of the required kind
  kBudgetUsedUp,  ///< the search ended before it reached the goal
  kCollides,      ///< the drivable path comes too near to an obstacle
  kInfeasible,    ///< exceeds the car's limits; see feasibility.h
};

/// "ok", "too_few_waypoints", …: the spelling of plan.json.
const char* ToString(PlanStatus status);

}  // namespace trackbed

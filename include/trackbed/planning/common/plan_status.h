#pragma once

namespace trackbed {

/// How planning ended.
enum class PlanStatus {
  kOk,
  kTooFewWaypoints,     ///< a route needs at least three
  kDuplicateWaypoints,  ///< a leg of no length
  kUTurn,               ///< a leg turns back on itself: no fillet joins it
  kTurnTooTight,        ///< tighter than the car can steer, or no radius fits (C.34)
  kNoRoomForSteering,   ///< C.40 has no radius: the legs leave no distance for turning the wheels
  kTurnsOverlap,        ///< given radii need more of a leg than it has
  kSearchFailed,        ///< the search ended without a point that keeps the constraints
  kSteersBeforeStart,  ///< the wheels would have to start turning before the route begins (D_1 < 0)
  kStartBlocked,       ///< the car stands too near to an obstacle, or where there is no frame
  kGoalBlocked,        ///< an obstacle is too near to the goal, or to a waypoint on the way
  kNoPath,             ///< there is none, or none of the kind that is looked for
  kBudgetUsedUp,       ///< the search ended before it was there
  kCollides,           ///< what could be driven comes too near to an obstacle
  kInfeasible,         ///< it asks more of the car than it can do; see feasibility.h
};

/// "ok", "too_few_waypoints", …: the spelling of plan.json.
const char* ToString(PlanStatus status);

}  // namespace trackbed

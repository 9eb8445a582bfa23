#include "trackbed/planning/common/plan_status.h"

namespace trackbed {

const char* ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kOk:
      return "ok";
    case PlanStatus::kTooFewWaypoints:
      return "too_few_waypoints";
    case PlanStatus::kDuplicateWaypoints:
      return "duplicate_waypoints";
    case PlanStatus::kUTurn:
      return "u_turn";
    case PlanStatus::kTurnTooTight:
      return "turn_too_tight";
    case PlanStatus::kNoRoomForSteering:
      return "no_room_for_steering";
    case PlanStatus::kTurnsOverlap:
      return "turns_overlap";
    case PlanStatus::kSearchFailed:
      return "search_failed";
    case PlanStatus::kSteersBeforeStart:
      return "steers_before_start";
    case PlanStatus::kStartBlocked:
      return "start_blocked";
    case PlanStatus::kGoalBlocked:
      return "goal_blocked";
    case PlanStatus::kNoPath:
      return "no_path";
    case PlanStatus::kBudgetUsedUp:
      return "budget_used_up";
    case PlanStatus::kCollides:
      return "collides";
    case PlanStatus::kInfeasible:
      return "infeasible";
    case PlanStatus::kWaypointMissed:
      return "waypoint_missed";
  }
  return "";
}

}  // namespace trackbed
